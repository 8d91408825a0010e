#include "config/record/whole_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "config/schema/error.h"

namespace config::record {

void write_whole(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::path temporary = file;
  temporary += ".part" + std::to_string(getpid());
  errno = 0;
  std::ofstream out(temporary, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  const int error = errno;
  std::error_code renamed;
  if (out) std::filesystem::rename(temporary, file, renamed);
  if (!out || renamed) {
    const std::string why = renamed ? renamed.message() : std::strerror(error);
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw schema::Error(schema::ExitCode::failed, file.string() + ": cannot be written: " + why);
  }
}

}  // namespace config::record
