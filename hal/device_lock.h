// Exclusive use of a device by one process, where the kernel itself does not provide it (a Modbus
// address). The lock is a name on this machine that the kernel releases when the process ends.
#pragma once

#include <string>

namespace hal {

class DeviceLock {
 public:
  /// `name` identifies the device in every process; `where` begins the message. Throws
  /// config::schema::RunError while another process holds the lock.
  DeviceLock(const std::string& name, const std::string& where);
  ~DeviceLock();
  DeviceLock(const DeviceLock&) = delete;
  DeviceLock& operator=(const DeviceLock&) = delete;

 private:
  int file_;
};

}  // namespace hal
