#include "workbench/files/write_all.h"

#include <exception>
#include <string>

#include "config/schema/error.h"

namespace workbench::files {

void write_all(const std::vector<std::function<void()>>& writers) {
  std::string failed;
  std::exception_ptr other;
  for (const std::function<void()>& write : writers) {
    try {
      write();
    } catch (const config::schema::RunError& error) {
      failed += (failed.empty() ? "" : "; ") + std::string(error.what());
    } catch (...) {
      if (!other) other = std::current_exception();
    }
  }
  if (other) std::rethrow_exception(other);
  if (!failed.empty()) throw config::schema::RunError(failed);
}

}  // namespace workbench::files
