#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/exchange/run_products.h"
#include "core/orbit/elements/elements.h"

// Formats of other programs in which a run's products can be written. A format is one file pair of
// this directory and a row of `export_formats`; docs/exchange.md states its conventions.
namespace dmise {

enum class ProductKind { detections, truth, tracks };

/// A file to be written.
struct ExportedFile {
  std::string path;  // below the output directory; empty: the output is this file
  std::string content;
  std::string copy_of;  // if not empty: a file to copy instead of `content`
};

struct ExportRequest {
  const RunProducts& run;
  ProductKind kind = ProductKind::detections;
  std::vector<MeanElements> elements;  // from the run's catalogues, where the format takes them
};

struct ExportFormat {
  const char* name;
  const char* what;                // a line of help
  const char* file;                // path below RUN/export; without an ending: a directory
  std::vector<ProductKind> kinds;  // that it can hold, the default first
  bool takes_elements = false;
  bool all_kinds = false;  // unless one is asked for, all that the run has
  std::vector<ExportedFile> (*files)(const ExportRequest&);
};

const std::vector<ExportFormat>& export_formats();

/// "detections", "truth" or "tracks".
const char* name_of(ProductKind kind);

/// Throws `ConfigError` that the run has no `kind` for `message` ("a TDM"), which must not be
/// empty.
[[noreturn]] void fail_empty(const RunProducts& run, const char* message, ProductKind kind);

}  // namespace dmise
