// Text of a configuration with, beside each number, where it stands: in a device manual, on a data
// sheet, in a drawing.
#pragma once

#include <map>
#include <string>

namespace workbench::stand {

class TomlWriter {
 public:
  /// `sources`: where the answer to a question stands, by flag.
  explicit TomlWriter(std::map<std::string, std::string> sources) : sources_(std::move(sources)) {}

  /// A comment line of its own.
  void comment(const std::string& line);
  /// A comment between two parts of the file.
  void heading(const std::string& line);
  /// [name] or [[name]].
  void table(const std::string& name, const std::string& comment = "");
  void item(const std::string& name, const std::string& comment = "");

  void number(const std::string& key, double value, const std::string& comment = "");
  void whole(const std::string& key, double value, const std::string& comment = "");
  void text(const std::string& key, const std::string& value, const std::string& comment = "");
  void boolean(const std::string& key, bool value, const std::string& comment = "");
  /// A number with the source of that question's answer as comment.
  void asked(const std::string& key, double value, const std::string& flag);
  void asked_whole(const std::string& key, double value, const std::string& flag);
  void asked_text(const std::string& key, const std::string& value, const std::string& flag);

  [[nodiscard]] const std::string& str() const noexcept { return text_; }

 private:
  void line(const std::string& assignment, const std::string& comment);

  std::map<std::string, std::string> sources_;
  std::string text_;
};

}  // namespace workbench::stand
