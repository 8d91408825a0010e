// Claims on a device: of another daemon, of strangers, by other spellings of its address.
#include "hal/device_lock.h"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>

#include "config/schema/error.h"

namespace hal {
namespace {

std::string name_of(const char* which) {
  return std::string("test/") + which + std::to_string(getpid());
}

std::string refusal(const std::string& name) {
  try {
    const DeviceLock lock(name, "rig.toml: [modbus]");
  } catch (const config::schema::RunError& e) {
    return e.what();
  }
  return "claimed";
}

/// Another user who has taken the device's names, until this object ends.
class Stranger {
 public:
  explicit Stranger(const std::string& name) {
    int ready[2];
    EXPECT_EQ(pipe(ready), 0);
    EXPECT_EQ(pipe(end_), 0);
    child_ = fork();
    char byte = 0;
    if (child_ == 0) {
      close(end_[1]);
      bool good = setgid(65534) == 0 && setuid(65534) == 0;
      for (const std::string& taken : {"spoolwatch/" + name, "spoolwatch/" + name + "/1"}) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        const std::size_t n = taken.copy(address.sun_path + 1, sizeof address.sun_path - 1);
        const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + n);
        const int file = socket(AF_UNIX, SOCK_STREAM, 0);
        good = good && bind(file, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
               listen(file, 1) == 0;
      }
      (void)!write(ready[1], good ? "g" : "b", 1);
      (void)!read(end_[0], &byte, 1);
      _exit(0);
    }
    EXPECT_EQ(read(ready[0], &byte, 1), 1);
    EXPECT_EQ(byte, 'g');
    close(ready[0]);
    close(ready[1]);
  }
  ~Stranger() {
    close(end_[0]);
    close(end_[1]);
    waitpid(child_, nullptr, 0);
  }
  Stranger(const Stranger&) = delete;
  Stranger& operator=(const Stranger&) = delete;

 private:
  int end_[2];
  pid_t child_;
};

TEST(DeviceLock, IsOneForADeviceAndFreeAgainAfterItsHolder) {
  const std::string name = name_of("one");
  {
    const DeviceLock lock(name, "here");
    for (int i = 0; i < 5; ++i) {
      EXPECT_THAT(refusal(name), testing::AllOf(testing::StartsWith("rig.toml: [modbus]: process "),
                                                testing::HasSubstr("drives it")));
    }
    EXPECT_EQ(refusal(name + "0"), "claimed") << "another device";
  }
  EXPECT_EQ(refusal(name), "claimed");
}

TEST(DeviceLock, IsNotKeptFromTheDaemonByAStranger) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  const std::string name = name_of("stranger");
  const Stranger stranger(name);
  EXPECT_EQ(refusal(name), "claimed");
  const DeviceLock lock(name, "here");
  EXPECT_THAT(refusal(name), testing::HasSubstr("one device, one daemon"));
}

TEST(DeviceLock, KnowsTheAddressesOfThisMachineAsOne) {
  EXPECT_EQ(device_host("0.0.0.0"), "127.0.0.1");
  EXPECT_EQ(device_host("127.0.0.1"), "127.0.0.1");
  EXPECT_EQ(device_host("127.0.0.2"), "127.0.0.2");
  EXPECT_EQ(device_host("203.0.113.7"), "203.0.113.7");
}

}  // namespace
}  // namespace hal
