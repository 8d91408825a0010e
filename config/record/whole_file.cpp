#include "config/record/whole_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "config/schema/error.h"

namespace config::record {

namespace {

void write_to(const std::filesystem::path& file, std::string_view text, int& error) {
  errno = 0;
  std::ofstream out(file, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  error = out ? 0 : errno;
  if (!out && error == 0) error = EIO;
}

/// A device or a pipe (/dev/stdout, /dev/null): nothing may be put in its place.
bool is_special(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  return std::filesystem::is_character_file(status) || std::filesystem::is_fifo(status) ||
         std::filesystem::is_socket(status) || std::filesystem::is_block_file(status);
}

}  // namespace

void write_whole(const std::filesystem::path& file, std::string_view text) {
  const bool special = is_special(file);
  std::filesystem::path temporary = file;
  if (!special) temporary += ".part" + std::to_string(getpid());
  int error = 0;
  write_to(temporary, text, error);
  std::error_code renamed;
  if (error == 0 && !special) std::filesystem::rename(temporary, file, renamed);
  if (error != 0 || renamed) {
    const std::string why = renamed ? renamed.message() : std::strerror(error);
    std::error_code ignored;
    if (!special) std::filesystem::remove(temporary, ignored);
    throw schema::RunError(file.string() + ": cannot be written: " + why);
  }
}

}  // namespace config::record
