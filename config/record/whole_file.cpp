#include "config/record/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "config/schema/error.h"

namespace config::record {

namespace {

/// Zero, or the error of a file system that can sync.
int sync_error(int file) {
  if (fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS) return 0;
  return errno;
}

/// Gives the owner and the permissions of the file `like`, as far as the file system allows.
void keep_access(int file, const struct stat& like) {
  const bool owned = fchown(file, like.st_uid, like.st_gid) == 0;
  // Without the group, what is open to it would be open to another.
  const bool grouped = owned || fchown(file, static_cast<uid_t>(-1), like.st_gid) == 0;
  constexpr mode_t kAccess = S_IRWXU | S_IRWXG | S_IRWXO;
  (void)fchmod(file, like.st_mode & (grouped ? kAccess : kAccess & ~static_cast<mode_t>(S_IRWXG)));
}

/// Writes `text` and, to a regular file, until it is on the disk. `like`: the file that it
/// replaces; null: none. Zero, or the error.
int write_to(const std::filesystem::path& file, std::string_view text, bool special,
             const struct stat* like) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC;
  const mode_t mode = like == nullptr ? 0666 : S_IRUSR | S_IWUSR;
  const int out = open(file.c_str(), special ? kFlags : kFlags | O_NOFOLLOW, mode);
  if (out < 0) return errno;
  if (like != nullptr) keep_access(out, *like);
  int error = 0;
  while (error == 0 && !text.empty()) {
    const ssize_t written = write(out, text.data(), text.size());
    if (written == 0) error = EIO;  // would be so for ever
    if (written >= 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      error = errno;
    }
  }
  if (error == 0 && !special) error = sync_error(out);
  if (close(out) != 0 && error == 0) error = errno;
  return error;
}

/// Until the name of a renamed file is on the disk. Zero, or the error.
int sync_folder(const std::filesystem::path& folder) {
  const int opened =
      open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return errno == EACCES ? 0 : errno;  // files may be made in it, not listed
  const int error = sync_error(opened);
  close(opened);
  return error;
}

/// A device or a pipe (/dev/stdout, /dev/null): nothing may be put in its place.
bool is_special(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  return std::filesystem::is_character_file(status) || std::filesystem::is_fifo(status) ||
         std::filesystem::is_socket(status) || std::filesystem::is_block_file(status);
}

/// The file that a chain of links leads to, which need not exist.
std::filesystem::path behind_links(const std::filesystem::path& file) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::filesystem::path target = file;
  for (int links = 0; links <= kMostLinks; ++links) {
    std::error_code no_link;
    const std::filesystem::path next = std::filesystem::read_symlink(target, no_link);
    if (no_link) return target;
    target = target.parent_path() / next;  // `next` where that is absolute
  }
  throw schema::RunError(file.string() + ": cannot be written: " + std::strerror(ELOOP));
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
