#include "workbench/exchange/mat_writer.h"

#include <matio.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "config/schema/error.h"

namespace workbench::exchange {
namespace {

constexpr std::size_t kLongestName = 31;
/// A variable of version 5 ends at 2 GiB.
constexpr std::size_t kMostValues = ((std::size_t{1} << 31U) - 4096) / sizeof(double);

config::schema::RunError failed(const std::string& why) {
  return config::schema::RunError("a MAT file cannot be made: " + why);
}

matvar_t* checked(matvar_t* variable) {
  if (variable == nullptr) throw failed("out of memory");
  return variable;
}

// matio's interface is not const-correct: it copies what it is given.
template <class T>
void* given(const T* data) {
  return const_cast<T*>(data);
}

matvar_t* numbers(const double* data, std::size_t count) {
  if (count > kMostValues) throw failed("a column is longer than 2 GiB");
  std::array<std::size_t, 2> dims{count, 1};
  return checked(
      Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims.data(), given(data), 0));
}

std::string ascii(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool continues = (byte & 0xC0U) == 0x80U;  // byte of a letter of several bytes
    if (!continues) out += byte < 0x80U ? c : '?';
  }
  return out;
}

}  // namespace

std::string identifier(std::string_view name) {
  std::string out;
  for (const char c : name) {
    out += std::isalnum(static_cast<unsigned char>(c)) != 0 && (c & 0x80) == 0 ? c : '_';
  }
  if (out.empty() || std::isalpha(static_cast<unsigned char>(out[0])) == 0) out.insert(0, "x");
  return out.substr(0, kLongestName);
}

void MatValue::Free::operator()(matvar_t* variable) const noexcept { Mat_VarFree(variable); }

MatValue::MatValue(const std::vector<double>& column)
    : variable_(numbers(column.data(), column.size())) {}

MatValue::MatValue(double number) : variable_(numbers(&number, 1)) {}

MatValue::MatValue(bool flag) {
  std::array<std::size_t, 2> dims{1, 1};
  const mat_uint8_t value = flag ? 1 : 0;
  variable_.reset(checked(Mat_VarCreate(nullptr, MAT_C_UINT8, MAT_T_UINT8, 2, dims.data(),
                                        given(&value), MAT_F_LOGICAL)));
}

MatValue::MatValue(const std::string& text) {
  const std::string plain = ascii(text);
  std::array<std::size_t, 2> dims{plain.empty() ? std::size_t{0} : 1, plain.size()};
  variable_.reset(checked(
      Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UINT8, 2, dims.data(), given(plain.data()), 0)));
}

MatValue::MatValue(std::size_t size, const std::vector<std::string>& fields) {
  std::vector<const char*> names;
  names.reserve(fields.size());
  for (const std::string& field : fields) names.push_back(field.c_str());
  std::array<std::size_t, 2> dims{size, 1};
  variable_.reset(checked(Mat_VarCreateStruct(nullptr, 2, dims.data(), names.data(),
                                              static_cast<unsigned>(names.size()))));
}

void MatValue::set(std::size_t index, const std::string& field, MatValue value) {
  Mat_VarFree(Mat_VarSetStructFieldByName(variable_.get(), field.c_str(), index,
                                          value.variable_.release()));
}

/// matio writes to files by name: this one has no place on a disk.
struct MatWriter::State {
  int memory = ::memfd_create("mat", MFD_CLOEXEC);
  mat_t* file = nullptr;

  ~State() {
    if (file != nullptr) Mat_Close(file);
    if (memory >= 0) ::close(memory);
  }
};

MatWriter::MatWriter() : state_(std::make_unique<State>()) {
  const std::string path = "/proc/self/fd/" + std::to_string(state_->memory);
  if (state_->memory >= 0) {
    state_->file =
        Mat_CreateVer(path.c_str(), "MATLAB 5.0 MAT-file, written by spoolwatch", MAT_FT_MAT5);
  }
  if (state_->file == nullptr) throw failed(std::strerror(errno));
}

MatWriter::~MatWriter() = default;

void MatWriter::add(const std::string& name, MatValue value, bool with_texts) {
  matvar_t* variable = value.variable_.get();
  std::free(variable->name);
  variable->name = ::strdup(name.c_str());
  // Packed, matio states a wrong size for empty texts.
  const auto packing = with_texts ? MAT_COMPRESSION_NONE : MAT_COMPRESSION_ZLIB;
  if (Mat_VarWrite(state_->file, variable, packing) != 0) {
    throw failed("variable " + name + " cannot be written");
  }
}

std::string MatWriter::finish() {
  Mat_Close(state_->file);
  state_->file = nullptr;
  std::string text(static_cast<std::size_t>(::lseek(state_->memory, 0, SEEK_END)), '\0');
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n =
        ::pread(state_->memory, text.data() + done, text.size() - done, static_cast<off_t>(done));
    if (n <= 0) throw failed(std::strerror(errno));
    done += static_cast<std::size_t>(n);
  }
  return text;
}

}  // namespace workbench::exchange
