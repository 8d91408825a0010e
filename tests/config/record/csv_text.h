// Records from a text as a CSV file has it.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "config/record/reading.h"
#include "config/record/record.h"
#include "config/schema/error.h"
#include "tests/config/record/temporary_file.h"

namespace record_test {

inline const std::string kRows = "0,1,0.1\n0.005,2,0.2\n0.010,3,0.3\n";

inline config::record::Record read(const std::string& content, const std::string& map = "",
                                   const std::string& resample = "") {
  config::record::ReadOptions options;
  options.map = map;
  options.resample = resample;
  return config::record::read_record(TemporaryFile(content).path(), options);
}

/// Message of the refusal; "no error" where it does not.
inline std::string error_of(const std::string& content, const std::string& map = "") {
  try {
    (void)read(content, map);
  } catch (const config::schema::Error& error) {
    return error.what();
  }
  return "no error";
}

/// The message names the line and contains `part`; exit 65; one line.
inline void expect_bad(const std::string& content, const std::string& place,
                       const std::string& part) {
  const TemporaryFile file(content);
  try {
    (void)config::record::read_record(file.path());
    ADD_FAILURE() << "accepted: " << content;
  } catch (const config::schema::DataError& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find(file.path() + place + ": "), 0U) << what;
    EXPECT_NE(what.find(part), std::string::npos) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
  }
}

}  // namespace record_test
