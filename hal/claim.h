// A device that one process may drive at a time, where the kernel itself does not see to that (a
// Modbus address). The claim is a name on this machine: the process loses it with its life, however
// that ends.
#pragma once

#include <string>

namespace hal {

class Claim {
 public:
  /// `name`: of the device, as every process spells it; `where` opens the message. Throws
  /// config::schema::RunError while another process has it.
  Claim(const std::string& name, const std::string& where);
  ~Claim();
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

 private:
  int file_;
};

}  // namespace hal
