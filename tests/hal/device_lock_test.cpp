// Claims on a device: of another daemon, of strangers, by other spellings of its address.
#include "hal/device_lock.h"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>

#include "config/schema/error.h"
#include "tests/forked_child.h"

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
class Stranger : public tests::ForkedChild {
 public:
  explicit Stranger(const std::string& name) : Stranger(name, Ready()) {}

 private:
  struct Ready {
    int ends[2] = {-1, -1};
    Ready() { EXPECT_EQ(pipe(ends), 0); }
  };
  Stranger(const std::string& name, const Ready& ready)
      : ForkedChild([&](int end) {
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
          char byte = good ? 'g' : 'b';
          (void)!write(ready.ends[1], &byte, 1);
          (void)!read(end, &byte, 1);
        }) {
    char byte = 0;
    EXPECT_EQ(read(ready.ends[0], &byte, 1), 1);
    EXPECT_EQ(byte, 'g');
    close(ready.ends[0]);
    close(ready.ends[1]);
  }
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
