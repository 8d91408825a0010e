// The variables of an HDF5 file: MATLAB's version 7.3, h5py, PyTables and the like.
//
// Groups are structures, datasets of numbers with one long extent are vectors, tables (compound
// types, or several columns) are structures of their columns. An attribute unit or units states a
// dataset's unit. MATLAB's own groups (#refs#, #subsystem#) are passed over; its objects, such as
// timeseries, are named and not read: their layout is not documented.
//
// The HDF5 library trusts the lengths in a file further than the project's own readers do: a
// damaged file ends in an error as a rule, a hostile one need not. Programs that watch a stand do
// not link it (record.h, set_hdf5_reader).
#pragma once

#include <string>
#include <vector>

#include "config/record/mat_variables.h"

namespace config::record::hdf5 {

/// Throws schema::DataError.
[[nodiscard]] std::vector<MatVariable> read_hdf5_variables(const std::string& file);

}  // namespace config::record::hdf5
