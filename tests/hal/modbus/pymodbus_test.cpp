// The backend against pymodbus, which knows nothing of it: every type in every order, as Python's
// struct lays them out, the four tables, and function 23; TCP, and RTU on a pseudo-terminal.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <cstdio>
#include <sstream>

#include "tests/hal/modbus/stand.h"

namespace hal::modbus {
namespace {

struct Kind {
  const char* type;
  double value;
};
constexpr Kind kKinds[] = {{"int16", -12345.0},
                           {"uint16", 54321.0},
                           {"int32", -123456789.0},
                           {"uint32", 3456789012.0},
                           {"float32", static_cast<double>(-1234.5678F)}};
constexpr const char* kOrders[] = {"ABCD", "CDAB", "BADC", "DCBA"};

/// The server as a process, its standard output as lines.
class Server {
 public:
  explicit Server(const std::string& serial = "") {
    int pipe_ends[2];
    (void)!pipe(pipe_ends);
    pid_ = fork();
    if (pid_ == 0) {
      dup2(pipe_ends[1], STDOUT_FILENO);
      const char* script = SPOOLWATCH_SOURCE_DIR "/tests/hal/modbus/pymodbus_server.py";
      execl("/usr/bin/python3", "python3", script, serial.empty() ? "tcp" : "rtu", serial.c_str(),
            nullptr);
      _exit(127);
    }
    close(pipe_ends[1]);
    lines_ = fdopen(pipe_ends[0], "r");
    std::istringstream(line()) >> word_ >> port_;
  }
  ~Server() {
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
    (void)fclose(lines_);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// The next line, waited for; empty when the server has ended.
  std::string line() {
    char text[200];
    return fgets(text, sizeof text, lines_) == nullptr ? "" : text;
  }
  [[nodiscard]] bool up() const { return word_ == "port"; }
  [[nodiscard]] std::string address() const {
    return "address = \"127.0.0.1:" + std::to_string(port_) + "\"\n";
  }

 private:
  pid_t pid_ = -1;
  FILE* lines_ = nullptr;
  std::string word_;
  int port_ = 0;
};

/// Two pseudo-terminals whose outer ends are copied into each other: a null-modem cable.
class Cable {
 public:
  Cable() {
    for (End& end : ends_) {
      char name[128];
      openpty(&end.outer, &end.inner, name, nullptr, nullptr);
      termios raw{};
      tcgetattr(end.inner, &raw);
      cfmakeraw(&raw);
      tcsetattr(end.inner, TCSANOW, &raw);
      end.name = name;
      fcntl(end.outer, F_SETFL, O_NONBLOCK);
    }
    thread_ = std::thread([this] {
      while (!stop_.load()) {
        for (int i = 0; i < 2; ++i) {
          char bytes[256];
          const ssize_t count = read(ends_[i].outer, bytes, sizeof bytes);
          if (count > 0) (void)!write(ends_[1 - i].outer, bytes, static_cast<std::size_t>(count));
        }
        std::this_thread::sleep_for(std::chrono::microseconds(200));
      }
    });
  }
  ~Cable() {
    stop_.store(true);
    thread_.join();
    for (const End& end : ends_) {
      close(end.outer);
      close(end.inner);
    }
  }
  Cable(const Cable&) = delete;
  Cable& operator=(const Cable&) = delete;
  [[nodiscard]] const std::string& end(int i) const { return ends_[i].name; }

 private:
  struct End {
    int outer = -1;
    int inner = -1;
    std::string name;
  };
  End ends_[2];
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

const std::string kWaits =
    "timeout_s = 1.0\njitter_s = 10.0\nconnect_timeout_s = 2.0\npriority = 0\n";

std::string entry(const std::string& name, const std::string& role, int address,
                  const std::string& type, const std::string& order) {
  return "[modbus.registers." + name + "]\nrole = \"" + role +
         "\"\naddress = " + std::to_string(address) + "\ntype = \"" + type + "\"\norder = \"" +
         order + "\"\n";
}

TEST(Pymodbus, ReadsEveryTypeInEveryOrderAsPythonsStructWritesThem) {
  Server server;
  ASSERT_TRUE(server.up()) << "python3-pymodbus does not start";
  for (const std::string table : {"holding", "input"}) {
    std::string text = server.address() + kWaits;
    int index = 0;
    for (const Kind& kind : kKinds) {
      for (const char* order : kOrders) {
        // sixteen requests at most: the rest is another connection's
        if ((index < 12) == (table == "holding")) {
          text += entry("r" + std::to_string(index), "input", 10 * index, kind.type, order) +
                  "function = \"" + table + "\"\n";
        }
        ++index;
      }
    }
    const BackendDevices devices = open_text(text);
    for (const auto& [name, input] : devices.inputs) {
      const int i = std::stoi(name.substr(1));
      EXPECT_EQ(input->read({0, 0}).value, kKinds[i / 4].value)
          << kKinds[i / 4].type << " " << kOrders[i % 4];
    }
  }
}

/// Turns until the server says that this has been written; each turn lets it say something.
bool written(Stand& stand, Server& server, double u_V, const std::string& line) {
  for (int i = 0; i < 100; ++i) {
    stand.turn(u_V);
    if (server.line() == line) return true;
  }
  return false;
}

TEST(Pymodbus, WritesEveryTypeInEveryOrderAsPythonsStructReadsThem) {
  // As Python prints them.
  const char* texts[] = {"-12345", "54321", "-123456789", "3456789012", "-1234.5677490234375"};
  int index = 0;
  for (int k = 0; k < 5; ++k) {
    Server server;
    ASSERT_TRUE(server.up());
    for (const char* order : kOrders) {
      Stand stand(server.address() + kWaits + entry("position", "rod", 500, "uint16", "ABCD") +
                  entry("u", "valve_command", 1000 + 10 * index, kKinds[k].type, order));
      EXPECT_TRUE(written(stand, server, kKinds[k].value,
                          "wrote " + std::to_string(index) + " " + texts[k] + "\n"))
          << kKinds[k].type << " " << order;
      ++index;
    }
  }
}

TEST(Pymodbus, ReadsCoilsAndDiscreteInputsAndSetsCoils) {
  Server server;
  ASSERT_TRUE(server.up());
  const BackendDevices devices =
      open_text(server.address() + kWaits +
                "[modbus.registers.coil1]\nrole=\"input\"\naddress=1\nfunction=\"coil\"\n"
                "[modbus.registers.coil2]\nrole=\"input\"\naddress=2\nfunction=\"coil\"\n"
                "[modbus.registers.d0]\nrole=\"input\"\naddress=0\nfunction=\"discrete\"\n"
                "[modbus.registers.d1]\nrole=\"input\"\naddress=1\nfunction=\"discrete\"\n"
                "[modbus.registers.permit]\nrole=\"output\"\naddress=3\nfunction=\"coil\"\n"
                "[modbus.registers.seen]\nrole=\"input\"\naddress=0\nfunction=\"coil\"\n");
  EXPECT_EQ(devices.inputs.at("coil1")->read({0, 0}).value, 1.0);
  EXPECT_EQ(devices.inputs.at("coil2")->read({0, 0}).value, 0.0);
  EXPECT_EQ(devices.inputs.at("d0")->read({0, 0}).value, 1.0);
  EXPECT_EQ(devices.inputs.at("d1")->read({0, 0}).value, 0.0);
  EXPECT_TRUE(devices.outputs.at("permit")->set(false));
  const BackendDevices watcher = open_text(server.address() + kWaits +
                                           "[modbus.registers.c]\nrole=\"input\"\naddress=3\n"
                                           "function=\"coil\"\n");
  std::int64_t tick = 0;
  EXPECT_TRUE(eventually([&] { return watcher.inputs.at("c")->read({++tick, 0}).value == 0.0; }));
}

TEST(Pymodbus, Function23) {
  Server server;
  ASSERT_TRUE(server.up());
  Stand stand(server.address() + kWaits + "combined = true\n" +
              entry("position", "rod", 500, "uint16", "ABCD") +
              entry("u", "valve_command", 1160, "float32", "ABCD"));
  EXPECT_EQ(stand.read().y_m, 4242.0);
  EXPECT_TRUE(written(stand, server, 1.5, "wrote 16 1.5\n"));
  EXPECT_TRUE(stand.turn_until(config::signals::Quality::good, 1.5));
}

TEST(Pymodbus, SpeaksRtu) {
  Cable cable;
  Server server(cable.end(0));
  ASSERT_TRUE(server.up());
  Stand stand("serial = \"" + cable.end(1) + "\"\nbaud = 115200\nparity = \"none\"\n" + kWaits +
              entry("position", "rod", 500, "uint16", "ABCD") +
              entry("u", "valve_command", 1160, "float32", "ABCD") +
              entry("int", "input", 80, "int32", "ABCD"));
  EXPECT_EQ(stand.read().y_m, 4242.0);
  EXPECT_EQ(stand.devices().inputs.at("int")->read({1, 0}).value, -123456789.0);
  EXPECT_TRUE(written(stand, server, 1.5, "wrote 16 1.5\n"));
}

}  // namespace
}  // namespace hal::modbus
