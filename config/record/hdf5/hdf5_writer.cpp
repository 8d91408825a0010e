#include "config/record/hdf5/hdf5_writer.h"

#include <hdf5.h>

#include <algorithm>
#include <vector>

#include "config/record/hdf5/handle.h"
#include "config/schema/error.h"

namespace config::record::hdf5 {
namespace {

/// Bytes by which the file grows in memory.
constexpr std::size_t kGrowth = std::size_t{1} << 20U;

void require(bool good) {
  if (!good) throw schema::RunError("HDF5: the library writes no file");
}

void add(hid_t file, std::string name, const std::vector<double>& values) {
  std::replace(name.begin(), name.end(), '/', '_');  // a stroke would make a group
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Handle column(H5Dcreate2(file, name.c_str(), H5T_IEEE_F64LE, space.get(), H5P_DEFAULT,
                                 H5P_DEFAULT, H5P_DEFAULT),
                      H5Dclose);
  require(column.valid() && H5Dwrite(column.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                     values.data()) >= 0);
}

}  // namespace

std::string hdf5_file(const Record& record) {
  (void)H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Handle memory(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  require(memory.valid() && H5Pset_fapl_core(memory.get(), kGrowth, 0) >= 0);
  const Handle file(H5Fcreate("record.h5", H5F_ACC_TRUNC, H5P_DEFAULT, memory.get()), H5Fclose);
  require(file.valid());
  add(file.get(), "t_s", record.t_s);
  add(file.get(), "u_" + record.command_unit, record.u_V);
  add(file.get(), "y_" + record.position_unit, record.y_m);
  for (const auto& [name, values] : record.further) add(file.get(), name, values);
  require(H5Fflush(file.get(), H5F_SCOPE_GLOBAL) >= 0);
  const ssize_t size = H5Fget_file_image(file.get(), nullptr, 0);
  require(size > 0);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  require(H5Fget_file_image(file.get(), bytes.data(), bytes.size()) == size);
  return bytes;
}

}  // namespace config::record::hdf5
