#include "core/base/module.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/own_file.h"

namespace dmise {
namespace {

using testing::HasSubstr;

std::string complaint(const char* path, const char* entry) {
  setenv("DMISE_TEST_MODULE", path, 1);
  try {
    made_by_module({"test", "DMISE_TEST_MODULE"}, entry);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(Module, OneThatIsNotThereIsNamed) {
  EXPECT_THAT(complaint("/nonexistent/libdmise_test.so", "entry"),
              HasSubstr("test module cannot be loaded: /nonexistent/libdmise_test.so"));
}

// zlib is a shared object without our entry.
TEST(Module, AnotherLibraryIsNoModule) {
  EXPECT_EQ(complaint("libz.so.1", "dmise_make_test"), "libz.so.1: is not a test module");
}

// In a module of Python it is the module: tests/clients/engine_frames.py.
TEST(OwnFile, OfAProgramIsTheProgram) {
  EXPECT_EQ(own_file(), std::filesystem::canonical("/proc/self/exe"));
}

}  // namespace
}  // namespace dmise
