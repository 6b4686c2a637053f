#include "launch/run/write_report.h"

#include <algorithm>
#include <memory>
#include <thread>

#include "core/base/error.h"
#include "core/base/files/whole_file.h"
#include "core/report/run_report.h"
#include "core/run/run_files.h"
#include "launch/run/star_catalogue_option.h"

namespace dmise {
namespace {

std::shared_ptr<const StarMap> stars_of(const std::string& name) {
  if (name.empty()) return nullptr;
  try {
    return load_star_catalogue(name);
  } catch (const Error&) {
    return nullptr;  // a run from another machine: its stars are not marked
  }
}

}  // namespace

std::string write_report(const std::string& directory, bool pixels, int threads) {
  const RunContents run = read_contents(directory);
  const auto processors = int(std::thread::hardware_concurrency());
  Threads pool(threads > 0 ? threads : std::clamp(processors, 1, 8));
  ReportSettings settings;
  if (!pixels) settings.max_views = 0;
  const std::string path = path_in(directory, run_file::page);
  write_file_whole(path,
                   run_report(run, stars_of(run.record.star_catalogue).get(), pool, settings));
  return path;
}

}  // namespace dmise
