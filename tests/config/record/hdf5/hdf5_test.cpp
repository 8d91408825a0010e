// Records from HDF5: MATLAB's version 7.3 as matio writes it, and files as h5py users make them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <matio.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "config/record/hdf5/hdf5_variables.h"
#include "config/record/record.h"
#include "config/record/unit_text.h"
#include "config/schema/error.h"
#include "tests/config/record/temporary_file.h"

namespace config::record::hdf5 {
namespace {

using record_test::TemporaryFile;
using testing::HasSubstr;

constexpr std::size_t kRows = 300;

class Hdf5 : public testing::Test {
 protected:
  Hdf5() {
    set_hdf5_reader(read_hdf5_variables);
    for (std::size_t k = 0; k < kRows; ++k) {
      t_s_.push_back(0.005 * static_cast<double>(k));
      u_V_.push_back(std::sin(0.1 * static_cast<double>(k)));
      y_mm_.push_back(305.0 + 0.25 * static_cast<double>(k));
    }
  }
  ~Hdf5() override { set_hdf5_reader(nullptr); }

  void expect_the_motion(const Record& record) const {
    ASSERT_EQ(record.size(), kRows);
    EXPECT_EQ(record.t_s, t_s_);
    EXPECT_EQ(record.u_V, u_V_);
    for (std::size_t k = 0; k < kRows; ++k) ASSERT_DOUBLE_EQ(record.y_m[k], 1e-3 * y_mm_[k]);
  }
  [[nodiscard]] Record read(const std::string& map = "") const {
    ReadOptions options;
    options.map = map;
    return read_record(file_.path(), options);
  }
  [[nodiscard]] std::string error(const std::string& map = "") const {
    try {
      (void)read(map);
    } catch (const schema::DataError& error) {
      return error.what();
    }
    return "no error";
  }

  /// A variable of matio's; `values` must outlive the file's writing.
  static matvar_t* column(const char* name, std::vector<double>& values) {
    std::size_t dims[2] = {values.size(), 1};
    return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, values.data(), 0);
  }
  void write_mat(const std::vector<matvar_t*>& variables) const {
    mat_t* const mat = Mat_CreateVer(file_.path().c_str(), nullptr, MAT_FT_MAT73);
    ASSERT_NE(mat, nullptr);
    for (matvar_t* variable : variables) {
      EXPECT_EQ(Mat_VarWrite(mat, variable, MAT_COMPRESSION_ZLIB), 0);
      Mat_VarFree(variable);
    }
    Mat_Close(mat);
  }

  static void write_vector(hid_t group, const char* name, const std::vector<double>& values,
                           const char* unit = nullptr) {
    const hsize_t size = values.size();
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    const hid_t set =
        H5Dcreate2(group, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    if (unit != nullptr) {
      const hid_t text = H5Tcopy(H5T_C_S1);
      H5Tset_size(text, H5T_VARIABLE);
      const hid_t scalar = H5Screate(H5S_SCALAR);
      const hid_t attribute = H5Acreate2(set, "units", text, scalar, H5P_DEFAULT, H5P_DEFAULT);
      H5Awrite(attribute, text, &unit);
      H5Aclose(attribute);
      H5Sclose(scalar);
      H5Tclose(text);
    }
    H5Dclose(set);
    H5Sclose(space);
  }

  static void set_number(hid_t object, const char* name, double value) {
    const hid_t scalar = H5Screate(H5S_SCALAR);
    const hid_t attribute =
        H5Acreate2(object, name, H5T_NATIVE_DOUBLE, scalar, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value);
    H5Aclose(attribute);
    H5Sclose(scalar);
  }

  /// An object of a class of MATLAB's: numbers that point into #subsystem#.
  static void write_object(hid_t group, const char* name, const std::string& of_class) {
    const hsize_t dims[] = {6, 1};
    const std::uint32_t points[] = {0xDD000000, 2, 1, 1, 1, 1};
    const hid_t space = H5Screate_simple(2, dims, nullptr);
    const hid_t scalar = H5Screate(H5S_SCALAR);
    const hid_t set =
        H5Dcreate2(group, name, H5T_NATIVE_UINT32, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, points);
    const hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, of_class.size());
    const hid_t class_name =
        H5Acreate2(set, "MATLAB_class", text, scalar, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(class_name, text, of_class.c_str());
    const hid_t decode =
        H5Acreate2(set, "MATLAB_object_decode", H5T_NATIVE_INT, scalar, H5P_DEFAULT, H5P_DEFAULT);
    const int kMcos = 3;
    H5Awrite(decode, H5T_NATIVE_INT, &kMcos);
    for (const hid_t attribute : {class_name, decode}) H5Aclose(attribute);
    for (const hid_t one : {space, scalar}) H5Sclose(one);
    H5Tclose(text);
    H5Dclose(set);
  }

  TemporaryFile file_{"", ".mat"};
  std::vector<double> t_s_;
  std::vector<double> u_V_;
  std::vector<double> y_mm_;
};

TEST_F(Hdf5, UnpacksScaledNumbers) {
  const hid_t file = H5Fcreate(file_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  std::vector<double> packed;
  for (const double y_mm : y_mm_) packed.push_back((y_mm - 300.0) / 0.25);
  write_vector(file, "t_s", t_s_);
  write_vector(file, "u_V", u_V_);
  write_vector(file, "y_mm", packed);
  const hid_t position = H5Dopen2(file, "y_mm", H5P_DEFAULT);
  set_number(position, "scale_factor", 0.25);
  set_number(position, "add_offset", 300.0);
  H5Dclose(position);
  H5Fclose(file);
  expect_the_motion(read());
}

TEST_F(Hdf5, RefusesConversionsOfOtherConventions) {
  for (const char* name : {"gain", "Scale", "conversion", "SCALE_FACTOR", "Offset", "ADD_OFFSET"}) {
    for (const double value : {1.0, 0.0, 100.0}) {
      const hid_t file = H5Fcreate(file_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
      write_vector(file, "t_s", t_s_);
      write_vector(file, "u_V", u_V_);
      write_vector(file, "y_mm", y_mm_);
      const hid_t position = H5Dopen2(file, "y_mm", H5P_DEFAULT);
      set_number(position, name, value);
      H5Dclose(position);
      H5Fclose(file);
      if (value == (folded(name).ends_with("offset") ? 0.0 : 1.0)) {
        expect_the_motion(read());
      } else {
        EXPECT_THAT(
            error(),
            testing::AllOf(HasSubstr(fmt::format("y_mm has the attribute {} {:g}", name, value)),
                           HasSubstr("--map")));
      }
    }
  }
}

TEST_F(Hdf5, RefusesConversionsOfColumnsAndInWords) {
  const auto written = [&](const auto& attribute) {
    const hid_t file = H5Fcreate(file_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    write_vector(file, "t_s", t_s_);
    write_vector(file, "u_V", u_V_);
    write_vector(file, "y_mm", y_mm_);
    const hid_t position = H5Dopen2(file, "y_mm", H5P_DEFAULT);
    attribute(position);
    H5Dclose(position);
    H5Fclose(file);
  };
  written([&](hid_t position) {
    const hsize_t count[] = {3};
    const double gains[] = {1.0, 0.1, 0.2};
    const hid_t space = H5Screate_simple(1, count, nullptr);
    const hid_t one =
        H5Acreate2(position, "gain", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(one, H5T_NATIVE_DOUBLE, gains);
    H5Aclose(one);
    H5Sclose(space);
  });
  EXPECT_THAT(error(), HasSubstr("y_mm has the attribute gain 1, 0.1, 0.2"));
  const auto set_text = [](hid_t position, const char* name, const std::string& value) {
    const hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, value.size());
    const hid_t scalar = H5Screate(H5S_SCALAR);
    const hid_t one = H5Acreate2(position, name, text, scalar, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(one, text, value.c_str());
    H5Aclose(one);
    H5Sclose(scalar);
    H5Tclose(text);
  };
  written([&](hid_t position) { set_text(position, "gain", "0.01"); });
  EXPECT_THAT(error(), HasSubstr("y_mm has the attribute gain 0.01"));
  written([&](hid_t position) { set_text(position, "calibration", "May 2024"); });
  expect_the_motion(read());
}

TEST_F(Hdf5, LeavesOutWhatIsFilledIn) {
  const hid_t file = H5Fcreate(file_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  std::vector<double> packed;
  for (const double y_mm : y_mm_) packed.push_back((y_mm - 300.0) / 0.25);
  packed[7] = -9999.0;
  write_vector(file, "t_s", t_s_);
  write_vector(file, "u_V", u_V_);
  write_vector(file, "y_mm", packed);
  const hid_t position = H5Dopen2(file, "y_mm", H5P_DEFAULT);
  set_number(position, "scale_factor", 0.25);
  set_number(position, "add_offset", 300.0);
  set_number(position, "_FillValue", -9999.0);
  H5Dclose(position);
  H5Fclose(file);
  const Record record = read();
  for (const double y_m : record.y_m) EXPECT_TRUE(!(y_m < 0.3)) << y_m;
}

TEST_F(Hdf5, ReadsVectorsOfVersion73) {
  write_mat({column("t_s", t_s_), column("u_V", u_V_), column("y_mm", y_mm_)});
  const Record record = read();
  expect_the_motion(record);
  EXPECT_EQ(record.form, "MAT file of version 7.3");
}

TEST_F(Hdf5, ReadsNestedStructuresOfVersion73) {
  const char* names[] = {"time", "cmd", "pos"};
  std::size_t one[2] = {1, 1};
  matvar_t* const inner = Mat_VarCreateStruct("signals", 2, one, names, 3);
  Mat_VarSetStructFieldByName(inner, "time", 0, column("time", t_s_));
  Mat_VarSetStructFieldByName(inner, "cmd", 0, column("cmd", u_V_));
  Mat_VarSetStructFieldByName(inner, "pos", 0, column("pos", y_mm_));
  const char* outer_names[] = {"signals"};
  matvar_t* const outer = Mat_VarCreateStruct("run", 2, one, outer_names, 1);
  Mat_VarSetStructFieldByName(outer, "signals", 0, inner);
  write_mat({outer});
  EXPECT_THAT(error(), HasSubstr("probably: --map 't=time[s],u=cmd[V],y=pos[mm]'"));
  expect_the_motion(read("t=time[s],u=cmd[V],y=pos[mm]"));
}

TEST_F(Hdf5, SaysInOneLineHowToSaveWhatIsInMatlabsObjects) {
  const hid_t file = H5Fcreate(file_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  write_object(file, "u", "timeseries");
  write_object(file, "y", "timeseries");
  H5Gclose(H5Gcreate2(file, "#subsystem#", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Fclose(file);
  EXPECT_THAT(error(), HasSubstr("u and y are objects (timeseries), whose layout in a file MATLAB "
                                 "does not document; in MATLAB: t = u.Time; u = squeeze(u.Data); "
                                 "y = squeeze(y.Data); save("));
  EXPECT_EQ(error().find('\n'), std::string::npos);
}

TEST_F(Hdf5, TakesUnitsFromAttributesAndGroupsAsStructures) {
  const hid_t file = H5Fcreate(file_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t group = H5Gcreate2(file, "stand3", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  write_vector(group, "Time", t_s_, "s");
  write_vector(group, "Valve command", u_V_, "V");
  write_vector(group, "Position", y_mm_, "mm");
  H5Gclose(group);
  H5Fclose(file);
  const Record record = read();
  expect_the_motion(record);
  EXPECT_EQ(record.form, "HDF5");
}

TEST_F(Hdf5, ReadsTheColumnsOfAMatrixByNumber) {
  std::vector<double> rows;
  for (std::size_t k = 0; k < kRows; ++k) rows.insert(rows.end(), {t_s_[k], u_V_[k], y_mm_[k]});
  const hid_t file = H5Fcreate(file_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t dims[] = {kRows, 3};
  const hid_t space = H5Screate_simple(2, dims, nullptr);
  const hid_t set =
      H5Dcreate2(file, "data", H5T_IEEE_F64BE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
  H5Dclose(set);
  H5Sclose(space);
  H5Fclose(file);
  expect_the_motion(read("t=data.1[s],u=data.2[V],y=data.3[mm]"));
  EXPECT_THAT(error(), HasSubstr("it has: data.1, data.2, data.3"));
}

TEST_F(Hdf5, ReadsATableOfACompoundType) {
  struct Row {
    double t_s;
    float u_V;
    double y_mm;
  };
  std::vector<Row> rows;
  for (std::size_t k = 0; k < kRows; ++k) {
    u_V_[k] = static_cast<float>(u_V_[k]);
    rows.push_back({t_s_[k], static_cast<float>(u_V_[k]), y_mm_[k]});
  }
  const hid_t type = H5Tcreate(H5T_COMPOUND, sizeof(Row));
  H5Tinsert(type, "t_s", HOFFSET(Row, t_s), H5T_NATIVE_DOUBLE);
  H5Tinsert(type, "u_V", HOFFSET(Row, u_V), H5T_NATIVE_FLOAT);
  H5Tinsert(type, "y_mm", HOFFSET(Row, y_mm), H5T_NATIVE_DOUBLE);
  const hid_t file = H5Fcreate(file_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t size = kRows;
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  const hid_t set = H5Dcreate2(file, "run", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
  H5Dclose(set);
  H5Sclose(space);
  H5Tclose(type);
  H5Fclose(file);
  expect_the_motion(read());
}

TEST_F(Hdf5, RefusesEveryCutOfAFile) {
  write_mat({column("t_s", t_s_), column("u_V", u_V_), column("y_mm", y_mm_)});
  const auto whole = std::filesystem::file_size(file_.path());
  for (auto size = whole - 1; size > 600; size -= std::min<std::uintmax_t>(size - 600, 97)) {
    std::filesystem::resize_file(file_.path(), size);
    EXPECT_NE(error(), "no error") << size;
  }
}

TEST_F(Hdf5, RefusesAFileThatUnpacksToMoreThanAGibibyte) {
  const hid_t out = H5Fcreate(file_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  write_vector(out, "padding", std::vector<double>(20'000, 1.0));
  // Chunks that are never written cost nothing in the file.
  const hsize_t rows = (hsize_t{1} << 27U) + 1;
  const hsize_t chunk = 1 << 16U;
  const hid_t space = H5Screate_simple(1, &rows, nullptr);
  const hid_t packed = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(packed, 1, &chunk);
  H5Pset_deflate(packed, 9);
  H5Dclose(H5Dcreate2(out, "t_s", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, packed, H5P_DEFAULT));
  H5Pclose(packed);
  H5Sclose(space);
  H5Fclose(out);
  EXPECT_THAT(error(), HasSubstr("t_s is damaged or cut off"));
}

TEST_F(Hdf5, IsNamedWhereTheLibraryIsNotLinked) {
  write_mat({column("t_s", t_s_)});
  set_hdf5_reader(nullptr);
  EXPECT_THAT(error(), HasSubstr("is a MAT file of version 7.3 (HDF5)"));
}

}  // namespace
}  // namespace config::record::hdf5
