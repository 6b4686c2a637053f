#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/paths.h"
#include "core/base/printable.h"
#include "core/base/whole_file.h"
#include "core/config/search_path.h"
#include "core/exchange/export_format.h"
#include "core/orbit/catalogue.h"
#include "launch/commands.h"
#include "launch/progress.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::string run, to, out, sensor;
  std::vector<std::string> catalogues;
  bool truth = false, detections = false, tracks = false;
};

const ExportFormat& format_named(const std::string& name) {
  std::vector<std::string> names;
  for (const ExportFormat& format : export_formats()) {
    if (format.name == name) return format;
    names.push_back(format.name);
  }
  throw ConfigError("--to: must be one of " + joined(names) + ", got " + printable(name) +
                    did_you_mean(name, names));
}

ProductKind kind_of(const ExportOptions& options, const ExportFormat& format) {
  if (!options.truth && !options.detections && !options.tracks) return format.kinds.front();
  const auto kind = options.truth    ? ProductKind::truth
                    : options.tracks ? ProductKind::tracks
                                     : ProductKind::detections;
  if (std::find(format.kinds.begin(), format.kinds.end(), kind) == format.kinds.end())
    throw ConfigError(std::string("--") + name_of(kind) + ": " + format.name + " holds only " +
                      name_of(format.kinds.front()));
  return kind;
}

/// Path of a catalogue that a scenario names.
std::string path_of(const std::string& named) {
  const std::string path = named == "gpredict" ? find_catalogue("satellites.dat") : named;
  if (path.empty() || !path_exists(path))
    throw ConfigError("--catalogue: the run's catalogue is not found from here, got " +
                      printable(named));
  return path;
}

bool is_wanted(const MeanElements& e, const std::vector<std::string>& only) {
  const std::string number = std::to_string(e.catalogue_number);
  return only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string& name) {
           return name == number || name == e.name;
         });
}

std::vector<MeanElements> elements_of(const RunProducts& run, const ExportOptions& options) {
  std::vector<MeanElements> all;
  std::set<std::pair<std::uint32_t, std::string>> seen;
  const auto& given = options.catalogues;
  for (std::size_t i = 0; i < (given.empty() ? run.catalogues : given).size(); ++i) {
    const auto file = read_catalogue(given.empty() ? path_of(run.catalogues[i]) : given[i]);
    for (const MeanElements& e : file.elements) {
      if (!is_wanted(e, given.empty() ? run.only[i] : std::vector<std::string>{})) continue;
      if (seen.emplace(e.catalogue_number, e.name).second) all.push_back(e);
    }
  }
  return all;
}

void write(const ExportedFile& file, const fs::path& path) {
  if (path.has_parent_path()) make_directories(path.parent_path(), "--out");
  if (file.copy_of.empty()) return write_file_whole(path.string(), file.content);
  const std::string partial = WholeFile::partial_of(path.string());
  std::error_code error;
  fs::copy_file(file.copy_of, partial, fs::copy_options::overwrite_existing, error);
  if (!error) fs::rename(partial, path, error);
  if (error) throw Error(path.string() + ": can't be written: " + error.message());
}

fs::path export_kind(const ExportOptions& options, const ExportFormat& format, ProductKind kind) {
  Progress progress;
  const RunProducts run =
      read_products(options.run,
                    {.truth = kind == ProductKind::truth && !format.takes_elements,
                     .detections = kind != ProductKind::truth,
                     .tracks = kind == ProductKind::tracks,
                     .sensor = options.sensor},
                    [&](double share, const std::string& file) {
                      progress.show_share(share, "export: " + printable(file));
                    });
  progress.clear_line();
  ExportRequest request{.run = run, .kind = kind, .elements = {}};
  if (format.takes_elements && kind == ProductKind::truth)
    request.elements = elements_of(run, options);
  std::string name = format.file;
  if (const auto at = name.find("KIND"); at != std::string::npos)
    name.replace(at, 4,
                 format.takes_elements && kind == ProductKind::truth ? "objects" : name_of(kind));
  const fs::path out =
      options.out.empty() ? fs::path(options.run) / "export" / name : fs::path(options.out);
  for (const ExportedFile& file : format.files(request))
    write(file, file.path.empty() ? out : out / file.path);
  return out;
}

void run_export(const ExportOptions& options) {
  const ExportFormat& format = format_named(options.to);
  fs::path out;
  if (format.all_kinds && !options.truth && !options.detections && !options.tracks) {
    for (const ProductKind kind : format.kinds)
      if (kind != ProductKind::truth || path_exists(options.run + "/truth.jsonl"))
        out = export_kind(options, format, kind);
  } else {
    out = export_kind(options, format, kind_of(options, format));
  }
  std::printf("%s\n", out.c_str());
}

std::string format_help() {
  std::string text = "format:";
  for (const ExportFormat& format : export_formats())
    text += std::string("\n") + format.name + ": " + format.what;
  return text;
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto options = std::make_shared<ExportOptions>();
  auto* command = app.add_subcommand(
      "export", "Writes the products of a run in formats of other programs (docs/exchange.md)");
  command->add_option("run", options->run, "directory of a run that has ended")->required();
  command->add_option("--to", options->to, format_help())->required();
  command->add_option("--out", options->out,
                      "file or directory, as the format has it; by default below RUN/export");
  command->add_option("--sensor", options->sensor, "only products of this sensor");
  auto* truth = command->add_flag("--truth", options->truth, "what was, from truth.jsonl");
  command
      ->add_flag("--detections", options->detections,
                 "what the sensors found, from detections.jsonl")
      ->excludes(truth);
  command
      ->add_flag("--tracks", options->tracks,
                 "what the fusion node made of them, from tracks.jsonl")
      ->excludes(truth)
      ->excludes("--detections");
  command->add_option("--catalogue", options->catalogues,
                      "omm: files of element sets instead of those that the scenario names");
  command->callback([options] { run_export(*options); });
}

}  // namespace dmise
