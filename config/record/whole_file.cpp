#include "config/record/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "config/record/output_place.h"
#include "config/schema/error.h"

namespace config::record {

namespace {

/// Writes `text` and, to a regular file, until it is on the disk. `like`: the file that it
/// replaces; null: none. Zero, or the error.
int write_to(const std::filesystem::path& file, std::string_view text, bool special,
             const struct stat* like) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC;
  const mode_t mode = like == nullptr ? 0666 : S_IRUSR | S_IWUSR;
  const int out = open(file.c_str(), special ? kFlags : kFlags | O_NOFOLLOW, mode);
  if (out < 0) return errno;
  if (like != nullptr) keep_access(out, *like);
  int error = write_error(out, text);
  if (error == 0 && !special) error = sync_error(out);
  if (close(out) != 0 && error == 0) error = errno;
  return error;
}

}  // namespace

void write_whole(const std::filesystem::path& file, std::string_view text) {
  const bool special = is_special(file);
  const std::filesystem::path target = behind_links(file);
  std::filesystem::path temporary = special ? file : target;
  if (!special) temporary += ".part" + std::to_string(getpid());
  struct stat before {};
  const bool replaces = !special && stat(target.c_str(), &before) == 0 && S_ISREG(before.st_mode);
  const int error = write_to(temporary, text, special, replaces ? &before : nullptr);
  std::error_code renamed;
  if (error == 0 && !special) std::filesystem::rename(temporary, target, renamed);
  if (error != 0 || renamed) {
    const std::string why = renamed ? renamed.message() : std::strerror(error);
    std::error_code ignored;
    if (!special) std::filesystem::remove(temporary, ignored);
    throw schema::RunError(file.string() + ": cannot be written: " + why);
  }
  if (special) return;
  if (const int unsynced = sync_folder(target.parent_path()); unsynced != 0) {
    throw schema::RunError(file.string() +
                           ": is written, but its folder cannot be: " + std::strerror(unsynced) +
                           "; a loss of power may bring back the file before");
  }
}

}  // namespace config::record
