// Exclusive use of a device by one process, where the kernel itself does not provide it (a Modbus
// address). The claim is a name on this machine that the kernel releases when the process ends.
//
// Every process claims by a name of its own that nobody can guess, then looks for claims of others
// on the same device: a user who has nothing to do with the daemon cannot keep it, or `--null`,
// from the device by taking a name first. Claims of system accounts (uid below 1000), of the own
// user and of members of the own group count.
#pragma once

#include <string>

namespace hal {

class DeviceLock {
 public:
  /// `name` identifies the device in every process; `where` begins the message. Throws
  /// config::schema::RunError while another process has a claim that counts.
  DeviceLock(const std::string& name, const std::string& where);
  ~DeviceLock();
  DeviceLock(const DeviceLock&) = delete;
  DeviceLock& operator=(const DeviceLock&) = delete;

 private:
  int file_;
};

/// The host part of a device's name: one name for all addresses of this machine that a connection
/// to `host` (numeric, IPv4) may end at.
[[nodiscard]] std::string device_host(const std::string& host);

}  // namespace hal
