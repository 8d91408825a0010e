// Every output is written, whatever becomes of the others.
#include "workbench/files/write_all.h"

#include <gtest/gtest.h>

#include <new>

#include "config/schema/error.h"

namespace workbench::files {
namespace {

using config::schema::RunError;

TEST(WriteAll, NamesAllThatFailedAfterTheLast) {
  bool last = false;
  try {
    write_all({[] { throw RunError("a: is full"); }, [] { throw RunError("b: is full"); },
               [&] { last = true; }});
    FAIL() << "nothing was thrown";
  } catch (const RunError& error) {
    EXPECT_STREQ(error.what(), "a: is full; b: is full");
  }
  EXPECT_TRUE(last);
}

TEST(WriteAll, AnotherExceptionKeepsNoWriterFromRunning) {
  bool last = false;
  EXPECT_THROW(write_all({[] { throw std::bad_alloc(); }, [&] { last = true; }}), std::bad_alloc);
  EXPECT_TRUE(last);
}

}  // namespace
}  // namespace workbench::files
