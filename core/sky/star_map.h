#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/base/mapped_file.h"
#include "core/sky/star_catalogue.h"
#include "core/sky/star_index.h"

namespace dmise {

/// A catalogue as the renderer uses it: in the index's order, with its index.
struct StarMap {
  StarTable stars;
  StarIndex index;
  std::vector<std::string> problems;       // `file:line: reason` of what could not be used
  std::shared_ptr<const MappedFile> file;  // that holds the columns; null: they are in memory
  bool from_cache = false;
  std::string cache_problem;  // why nothing was kept for the next time; empty when all is well
};

}  // namespace dmise
