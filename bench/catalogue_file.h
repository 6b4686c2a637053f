#pragma once
#include <filesystem>
#include <string>

namespace dmise {

/// A catalogue of 18,470 objects and a dark evening over North America near its epoch.
struct WrittenCatalogue {
  std::string path, start_utc;
};

/// The real one of December 2019 if `$DMISE_DATA` has it, or a similar one written to `directory`.
WrittenCatalogue catalogue_of_18470(const std::filesystem::path& directory);

}  // namespace dmise
