// Writes MAT files, version 5, through matio: columns of numbers, texts, structures.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct matvar_t;

namespace workbench::exchange {

/// "a1" for "a1", "x1st_order" for "1st order": a name that MATLAB takes, at most 31 characters.
[[nodiscard]] std::string identifier(std::string_view name);

/// A variable of a MAT file, or a field of a structure.
class MatValue {
 public:
  explicit MatValue(const std::vector<double>& column);
  explicit MatValue(double number);
  explicit MatValue(bool flag);
  /// Letters beyond ASCII become question marks: programs do not agree on them.
  explicit MatValue(const std::string& text);
  /// A column of `size` structures, all with these fields; set() fills them.
  MatValue(std::size_t size, const std::vector<std::string>& fields);

  void set(std::size_t index, const std::string& field, MatValue value);

 private:
  friend class MatWriter;
  struct Free {
    void operator()(matvar_t* variable) const noexcept;
  };
  std::unique_ptr<matvar_t, Free> variable_;
};

class MatWriter {
 public:
  /// Throws config::schema::RunError when the system gives no memory for a file.
  MatWriter();
  ~MatWriter();
  MatWriter(const MatWriter&) = delete;
  MatWriter& operator=(const MatWriter&) = delete;

  /// `name` must be an identifier that has not been written. Throws like the constructor.
  void add(const std::string& name, MatValue value, bool with_texts = false);
  /// The whole file; nothing can be added after.
  [[nodiscard]] std::string finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace workbench::exchange
