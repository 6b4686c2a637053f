// The main function of all unit tests: each process has a temporary directory of its own, which
// goes with it. Tests run beside each other, and two processes may run tests of one program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  if (GTEST_FLAG_GET(list_tests)) {
    return RUN_ALL_TESTS();
  }
  std::string directory = (std::filesystem::temp_directory_path() / "dmise-test-XXXXXX").string();
  if (!mkdtemp(directory.data())) {
    std::perror(directory.c_str());
    return 1;
  }
  setenv("TEST_TMPDIR", directory.c_str(), 1);  // that of testing::TempDir
  const int code = RUN_ALL_TESTS();
  std::error_code left;
  std::filesystem::remove_all(directory, left);
  return code;
}
