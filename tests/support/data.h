#pragma once
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <string>

// Reference data that is not part of the project: `$DMISE_DATA`, else ../shared/data beside the
// checkout. Where a file is absent the test says so and skips; with DMISE_DATA set it fails.
namespace dmise::test {

inline bool exists(const std::string& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0;
}

inline std::string data_path(const std::string& name) {
  const char* root = std::getenv("DMISE_DATA");
  return (root ? std::string(root) : std::string(DMISE_SOURCE_DIR "/../shared/data")) + "/" + name;
}

/// The catalogues that are shipped: "stars.dat.gz", "demo.tle".
inline std::string catalogue_path(const std::string& name) {
  return std::string(DMISE_SOURCE_DIR "/launch/catalogues/") + name;
}

/// Tycho-2 as KStars has it: where `./dmise setup --tests` puts it, else in the reference data.
/// Empty where there is none.
inline std::string deep_stars_path() {
  for (const std::string& path : {std::string(DMISE_SOURCE_DIR "/build/data/deepstars.dat"),
                                  data_path("stars/deepstars.dat")})
    if (exists(path)) return path;
  return "";
}

}  // namespace dmise::test

/// Skips a test that lacks something; with DMISE_DATA set it fails instead. Streams like
/// GTEST_SKIP.
#define DMISE_SKIP()                                                                             \
  return GTEST_MESSAGE_("", std::getenv("DMISE_DATA") ? ::testing::TestPartResult::kFatalFailure \
                                                      : ::testing::TestPartResult::kSkip)

#define DMISE_NEEDS_FILE(path)                                                                 \
  do {                                                                                         \
    if (!dmise::test::exists(path)) {                                                          \
      if (std::getenv("DMISE_DATA")) FAIL() << "DMISE_DATA is set but there is no " << (path); \
      GTEST_SKIP() << "needs " << (path);                                                      \
    }                                                                                          \
  } while (0)
