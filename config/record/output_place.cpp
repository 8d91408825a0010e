#include "config/record/output_place.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "config/schema/error.h"

namespace config::record {

bool is_special(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  return std::filesystem::is_character_file(status) || std::filesystem::is_fifo(status) ||
         std::filesystem::is_socket(status) || std::filesystem::is_block_file(status);
}

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

void keep_access(int file, const struct stat& like) {
  const bool owned = fchown(file, like.st_uid, like.st_gid) == 0;
  // Without the group, what is open to it would be open to another.
  const bool grouped = owned || fchown(file, static_cast<uid_t>(-1), like.st_gid) == 0;
  constexpr mode_t kAccess = S_IRWXU | S_IRWXG | S_IRWXO;
  (void)fchmod(file, like.st_mode & (grouped ? kAccess : kAccess & ~static_cast<mode_t>(S_IRWXG)));
}

int write_error(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(file, text.data(), text.size());
    if (written == 0) return EIO;  // would be so for ever
    if (written > 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

int sync_error(int file) {
  if (fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS) return 0;
  return errno;
}

int sync_folder(const std::filesystem::path& folder) {
  const int opened =
      open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return errno == EACCES ? 0 : errno;  // files may be made in it, not listed
  const int error = sync_error(opened);
  close(opened);
  return error;
}

}  // namespace config::record
