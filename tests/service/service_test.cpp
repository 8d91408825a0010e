// The life of the service under a real systemd, as the package brings it: installed, started,
// armed, stopped, killed, misconfigured, upgraded, removed. A watcher on the rig's registers holds
// the valve against what `--check` states.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/service/bench.h"
#include "tests/service/listener.h"

namespace service {
namespace {

using testing::HasSubstr;
using testing::Not;

double since_s(std::int64_t from_ns) {
  return static_cast<double>(hal::monotonic_ns() - from_ns) * 1e-9;
}

class Life : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    service_ = new Service;
    const Machine& machine = service_->machine_;
    const Output installed = machine.run("apt-get install -y /work/" + deb(0) + " </dev/null");
    ASSERT_EQ(installed.exit_code, 0) << installed.text;
    ASSERT_EQ(machine.run("useradd -G spoolwatch operator1 && useradd guest1").exit_code, 0);
    let_be_prompt(machine);
  }
  /// Where this machine lets nobody raise the limits that the unit asks for, capabilities take
  /// their place.
  static void let_be_prompt(const Machine& machine) {
    const Output limits = machine.run(
        "systemd-run --quiet --wait -p User=spoolwatch -p LimitRTPRIO=90 -p LimitMEMLOCK=256M "
        "sh -c 'chrt -f 80 true && [ $(ulimit -l) -gt 65536 ]'");
    if (limits.exit_code == 0) return;
    std::printf("# no limits here can be raised: capabilities instead\n");
    const char* folder = "/etc/systemd/system/spoolwatchd.service.d";
    machine.run(std::string("mkdir -p ") + folder);
    machine.write(std::string(folder) + "/test.conf",
                  "[Service]\nAmbientCapabilities=CAP_SYS_NICE CAP_IPC_LOCK\n"
                  "CapabilityBoundingSet=CAP_SYS_NICE CAP_IPC_LOCK\n");
    machine.run("systemctl daemon-reload");
  }
  static void TearDownTestSuite() { delete service_; }

  /// Running, by orders, whatever the test before has left.
  void SetUp() override {
    ASSERT_FALSE(HasFatalFailure());
    service_->machine_.run("systemctl reset-failed spoolwatchd");
    EXPECT_EQ(hal::hil_rig::set_remotely(service_->rig_.address(), "command_timeout_s=0.05"), "");
  }
  void run_anew() {
    s().configure();
    s().machine_.run("systemctl stop spoolwatchd");
    s().starts();
    s().runs();
  }

  static std::string deb(std::size_t index) {
    std::istringstream names(std::getenv("SPOOLWATCH_PACKAGES"));
    std::string name;
    for (std::size_t i = 0; i <= index; ++i) names >> name;
    return name;
  }
  static Service& s() { return *service_; }
  static const Machine& machine() { return service_->machine_; }

 private:
  static Service* service_;
};

Service* Life::service_ = nullptr;

TEST_F(Life, A_InstalledItIsThereAndNotStarted) {
  EXPECT_EQ(machine().property("ActiveState"), "inactive");
  EXPECT_EQ(machine().property("UnitFileState"), "disabled");
  EXPECT_EQ(machine().run("id -un spoolwatch").text, "spoolwatch\n");
  EXPECT_THAT(machine().run("id -Gn spoolwatch").text, HasSubstr("dialout"));
  const Output check = machine().run(std::string("spoolwatchd --check --config ") + kConfiguration);
  EXPECT_EQ(check.exit_code, 0) << check.text;
  for (const char* file :
       {"/usr/share/man/man8/spoolwatchd.8.gz", "/usr/share/man/man1/spoolwatch.1.gz",
        "/usr/share/man/man1/spoolwatch-rig.1.gz",
        "/usr/share/bash-completion/completions/spoolwatch",
        "/lib/udev/rules.d/60-spoolwatch.rules", "/usr/share/spoolwatch/messages/spoolwatch.lcm",
        "/usr/share/spoolwatch/models/thesis_calibrated.toml"}) {
    EXPECT_EQ(machine().run(std::string("test -s ") + file).exit_code, 0) << file;
  }
  const std::string rules = machine().run("udevadm test /sys/class/mem/null").text;
  EXPECT_THAT(rules, HasSubstr("60-spoolwatch.rules"));
  EXPECT_THAT(rules, Not(HasSubstr("60-spoolwatch.rules:"))) << "a rule that udev does not take";
}

TEST_F(Life, A_SamplesRunFromWhereThePackagePutsThem) {
  for (const char* command :
       {"spoolwatchd --config /usr/share/spoolwatch/demo.toml --clock virtual --duration 5 "
        "--lcm-url ''",
        "spoolwatch simulate /usr/share/spoolwatch/models/thesis_calibrated.toml --duration 4 "
        "-o /tmp/record.csv",
        "spoolwatch compare /usr/share/spoolwatch/models/thesis_calibrated.toml /tmp/record.csv",
        "spoolwatchd --config /usr/share/spoolwatch/thesis_case1.toml --check",
        "spoolwatch compare /usr/share/spoolwatch/models/rig_2000psi.toml "
        "/usr/share/spoolwatch/tour/steps.csv"}) {
    const Output output = machine().run(std::string("cd / && runuser -u guest1 -- ") + command);
    EXPECT_EQ(output.exit_code, 0) << command << "\n" << output.text;
  }
}

TEST_F(Life, B_StartedItIsReadyDisarmedAndInRealTime) {
  s().configure();
  const std::int64_t begin_ns = hal::monotonic_ns();
  s().starts();
  std::printf("# %-46s %7.0f ms\n", "from systemctl start to ready", since_s(begin_ns) * 1e3);
  EXPECT_EQ(machine().property("ActiveState"), "active");
  EXPECT_TRUE(machine().becomes("StatusText", "DISARMED, active alarms: 0"));
  EXPECT_THAT(s().journal(), HasSubstr("SCHED_FIFO 80; memory locked"));
  EXPECT_THAT(s().order("arm", "guest1").text, HasSubstr("spoolwatch: "));
  EXPECT_THAT(s().order("status").text, HasSubstr(": DISARMED"));
}

TEST_F(Life, C_ArmedItRunsAndAnotherProcessHearsItsAlarms) {
  Listener listener;
  s().runs();
  EXPECT_TRUE(machine().becomes("StatusText", "RUN"));
  std::this_thread::sleep_for(std::chrono::seconds(4));  // the estimators' warm-up
  const std::int64_t begin_ns = hal::monotonic_ns();
  EXPECT_EQ(hal::hil_rig::set_remotely(s().rig_.address(), "supply_pressure_Pa=x0.75"), "");
  const std::string alarm =
      listener.hears("\"name\":\"supply_pressure_fast\",\"severity\":\"MAJOR\"");
  std::printf("# %-46s %7.0f ms\n", "from the fault to the alarm elsewhere",
              since_s(begin_ns) * 1e3);
  const std::size_t at = alarm.find("\"mono_ns\":");
  ASSERT_NE(at, std::string::npos) << "no alarm";
  EXPECT_GT(std::stoll(alarm.substr(at + 10)), begin_ns) << "an alarm without a fault";
  EXPECT_THAT(alarm, HasSubstr("supply_pressure_Pa"));
  EXPECT_EQ(hal::hil_rig::set_remotely(s().rig_.address(), "supply_pressure_Pa=x1"), "");
}

TEST_F(Life, C_ReloadedItRunsOnByTheNewRulesAndKeepsTheOldOnesWhenTheyAreBroken) {
  run_anew();
  const pid_t before = machine().daemon();
  std::string text = s().configuration();
  replace(text, "low = 0.00018", "low = 0.00017");
  machine().write(kConfiguration, text);
  EXPECT_EQ(machine().run("systemctl reload spoolwatchd").exit_code, 0);
  EXPECT_TRUE(s().writes("new rules, configuration")) << s().journal();
  EXPECT_THAT(s().journal(), HasSubstr("1 keys changed"));
  s().configure("[controller.nonsense]\nx = 1\n");
  EXPECT_EQ(machine().run("systemctl reload spoolwatchd").exit_code, 0);
  EXPECT_TRUE(s().writes("the old configuration remains active")) << s().journal();
  std::this_thread::sleep_for(std::chrono::seconds(2));  // told once a second
  EXPECT_THAT(machine().property("StatusText"), HasSubstr("the old configuration remains active"));
  EXPECT_EQ(machine().daemon(), before);
  EXPECT_THAT(s().order("status").text, HasSubstr(": RUN"));
}

TEST_F(Life, D_StoppedTheWatchdogStartsItAgainDisarmed) {
  run_anew();
  const pid_t before = machine().daemon();
  ASSERT_GT(before, 0);
  const double stated_s = s().stated_s("process stopped");
  s().far_from_null();
  const std::int64_t begin_ns = hal::monotonic_ns();
  ASSERT_EQ(kill(before, SIGSTOP), 0);
  s().expect_null("SIGSTOP", begin_ns, stated_s);
  ASSERT_TRUE(machine().becomes("NRestarts", "1")) << s().journal();
  ASSERT_TRUE(machine().becomes("ActiveState", "active")) << s().journal();
  std::printf("# %-46s %7.1f s\n", "until it is up again", since_s(begin_ns));
  EXPECT_NE(machine().daemon(), before);
  EXPECT_THAT(s().journal(), HasSubstr("Watchdog timeout"));
  EXPECT_THAT(s().order("status").text, HasSubstr(": DISARMED"));
  s().stays_at_null_since(begin_ns);
}

TEST_F(Life, E_KilledItIsStartedAgainDisarmed) {
  run_anew();
  const double stated_s = s().stated_s("process killed");
  const pid_t before = machine().daemon();
  s().far_from_null();
  const std::int64_t begin_ns = hal::monotonic_ns();
  ASSERT_EQ(kill(before, SIGKILL), 0);
  s().expect_null("SIGKILL", begin_ns, stated_s);
  ASSERT_TRUE(machine().becomes("NRestarts", "1")) << s().journal();
  ASSERT_TRUE(machine().becomes("ActiveState", "active")) << s().journal();
  std::printf("# %-46s %7.1f s\n", "until it is up again", since_s(begin_ns));
  EXPECT_THAT(s().order("status").text, HasSubstr(": DISARMED"));
  s().stays_at_null_since(begin_ns);
}

TEST_F(Life, F_KilledWithABrokenConfigurationNullIsWrittenAndItStaysDown) {
  run_anew();
  // Nothing but what is run after the daemon's end takes this device's command away.
  ASSERT_EQ(hal::hil_rig::set_remotely(s().rig_.address(), "command_timeout_s=0"), "");
  machine().write(kConfiguration, "schema_version = \"none\"\n");
  const pid_t before = machine().daemon();
  s().far_from_null();
  const std::int64_t begin_ns = hal::monotonic_ns();
  ASSERT_EQ(kill(before, SIGKILL), 0);
  // systemd has to notice and to start a program: a second on a busy machine.
  s().expect_null("SIGKILL, device without time-out: ExecStopPost", begin_ns, 1.0);
  ASSERT_TRUE(machine().becomes("ActiveState", "failed")) << s().journal();
  EXPECT_EQ(machine().property("ExecMainStatus"), "78") << s().journal();
  std::this_thread::sleep_for(std::chrono::seconds(3));
  EXPECT_EQ(machine().property("ActiveState"), "failed") << "tried again with what cannot work";
  s().stays_at_null_since(begin_ns);
}

TEST_F(Life, G_RestartedWithABrokenConfigurationItStaysDownAtNull) {
  run_anew();
  const double stated_s = s().stated_s("stop, signal or error");
  s().configure("[controller.nonsense]\nx = 1\n");
  EXPECT_NE(machine().run("systemctl restart spoolwatchd").exit_code, 0);
  s().expect_null("restart with a broken configuration", machine().stopped_ns(), stated_s);
  EXPECT_EQ(machine().property("ActiveState"), "failed");
  EXPECT_EQ(machine().property("ExecMainStatus"), "78");
  EXPECT_THAT(s().journal(), HasSubstr("nonsense"));
  s().stays_at_null_since(machine().stopped_ns());
}

TEST_F(Life, H_ASecondDaemonIsRefused) {
  run_anew();
  const Output second = machine().run(std::string("spoolwatchd --config ") + kConfiguration);
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_THAT(second.text, HasSubstr("(spoolwatchd) drives it; one device, one daemon"));
  EXPECT_EQ(std::count(second.text.begin(), second.text.end(), '\n'), 1) << second.text;
  EXPECT_THAT(s().order("status").text, HasSubstr(": RUN"));
}

TEST_F(Life, I_WaitsForARigThatIsSwitchedOnLater) {
  s().configure();
  machine().run("systemctl stop spoolwatchd");
  std::string address;
  {
    const hal::hil_rig::RigProcess another({"--config", s().file_.path()});
    address = another.address();
  }
  std::string text = s().configuration();
  replace(text, s().rig_.address(), address);
  machine().write(kConfiguration, text);
  machine().run("systemctl start --no-block spoolwatchd");
  ASSERT_TRUE(machine().becomes("NRestarts", "2")) << s().journal();
  EXPECT_THAT(s().journal(), HasSubstr("cannot be connected (Connection refused)"));
  const hal::hil_rig::RigProcess another({"--config", s().file_.path()}, address);
  EXPECT_TRUE(machine().becomes("ActiveState", "active")) << s().journal();
  EXPECT_TRUE(machine().becomes("StatusText", "DISARMED"));
  machine().run("systemctl stop spoolwatchd");
}

TEST_F(Life, J_UpgradedItIsUpAgainDisarmed) {
  run_anew();
  const double stated_s = s().stated_s("stop, signal or error");
  const Output upgraded = machine().run("apt-get install -y /work/" + deb(1));
  ASSERT_EQ(upgraded.exit_code, 0) << upgraded.text;
  EXPECT_THAT(upgraded.text, HasSubstr("+1"));
  s().expect_null("upgrade", machine().stopped_ns(), stated_s);
  EXPECT_EQ(machine().property("ActiveState"), "active");
  EXPECT_THAT(s().order("status").text, HasSubstr(": DISARMED"));
  EXPECT_EQ(machine().run(std::string("grep -c ") + kLcm + " " + kConfiguration).text, "1\n")
      << "the configuration is its owner's";
  s().stays_at_null_since(machine().stopped_ns());
}

TEST_F(Life, K_RemovedItEndsAtNull) {
  run_anew();
  const double stated_s = s().stated_s("stop, signal or error");
  const Output removed = machine().run("apt-get remove -y spoolwatch");
  ASSERT_EQ(removed.exit_code, 0) << removed.text;
  const std::int64_t stopping_ns = machine().logged_ns("Stopping spoolwatchd");
  s().expect_null("remove", stopping_ns, stated_s);
  EXPECT_EQ(machine().run("pgrep spoolwatchd").exit_code, 1);
  EXPECT_EQ(machine().run(std::string("test -e ") + kConfiguration).exit_code, 0);
  EXPECT_EQ(machine().run("apt-get purge -y spoolwatch").exit_code, 0);
  EXPECT_EQ(machine().run("test -e /etc/spoolwatch -o -e /var/lib/spoolwatch").exit_code, 1);
}

}  // namespace
}  // namespace service
