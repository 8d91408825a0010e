// The folder of a session: records, model files, reports and session.json, ordinary files that the
// command line goes on with. What the browser names are plain file names in it, nothing else.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace workbench::serve {

struct FolderFile {
  std::string name;
  std::string kind;  ///< "record", "model" or "other"
  std::uintmax_t bytes = 0;
};

class SessionFolder {
 public:
  /// Made where it does not exist; leftovers of interrupted uploads are removed. Throws
  /// config::schema::RunError.
  explicit SessionFolder(std::filesystem::path folder);

  /// Files by name, at most kMostFiles of them; links and hidden files are left out.
  [[nodiscard]] std::vector<FolderFile> files() const;
  /// As commands take it: the bare name where the folder is the working directory. Throws
  /// config::schema::UsageError for what is not the name of a regular file of the folder.
  [[nodiscard]] std::string existing(const std::string& name) const;
  /// The path of a file to be written. Throws config::schema::UsageError for an unusable name.
  [[nodiscard]] std::string path_of(const std::string& name) const;
  /// "stem.toml", or "stem-2.toml" where that exists or is reserved; a stem too long for a name is
  /// cut.
  [[nodiscard]] std::string fresh_name(const std::string& name) const;
  /// Keeps fresh_name() from giving `name`, whose file is still to be written.
  void reserve(const std::string& name) { reserved_.insert(name); }
  void release(const std::string& name) { reserved_.erase(name); }
  /// A hidden file that an upload is written to.
  [[nodiscard]] std::filesystem::path upload_file() const;
  /// Gives an upload its name, or a fresh one like it; the name that it got. Throws
  /// config::schema::RunError.
  [[nodiscard]] std::string keep_upload(const std::filesystem::path& upload,
                                        const std::string& name) const;
  /// Why nothing can be written here, in one line; empty: it can. `tries`: by writing a file, else
  /// by what the system says of folder and space.
  [[nodiscard]] std::string trouble(bool tries) const;
  /// With its whole path.
  [[nodiscard]] const std::string& name() const { return name_; }

  static constexpr std::size_t kMostFiles = 1000;

 private:
  std::filesystem::path folder_;
  std::string name_;
  std::set<std::string> reserved_;
};

/// Name for a model made from `model`: "rig.toml" and "-fitted" make "rig-fitted.toml", and so does
/// "rig-fitted-2.toml": what was done by itself is in the lineage, not in longer and longer names.
[[nodiscard]] std::string derived_name(const std::string& model, const std::string& suffix);

/// No folder, no control character, no leading dot or minus, at most 100 bytes of UTF-8.
[[nodiscard]] bool is_plain_name(std::string_view name);

/// The models that come with the program.
struct ShippedModel {
  std::string_view name;  ///< "thesis.toml"
  std::string_view text;
};
[[nodiscard]] const std::vector<ShippedModel>& shipped_models();

}  // namespace workbench::serve
