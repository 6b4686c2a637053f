#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "core/base/error.h"
#include "core/base/files/digest.h"
#include "core/base/files/paths.h"
#include "core/base/files/regular_file.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/base/nearest_name.h"
#include "core/base/printable.h"
#include "core/config/objects/object_names.h"
#include "core/config/yaml/search_path.h"
#include "core/exchange/export_format.h"
#include "core/orbit/elements/catalogue.h"
#include "core/run/run_files.h"
#include "launch/command/command.h"
#include "launch/run/progress.h"

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
  if (std::find(format.kinds.begin(), format.kinds.end(), kind) == format.kinds.end()) {
    std::vector<std::string> holds;
    for (const ProductKind held : format.kinds) holds.emplace_back(name_of(held));
    throw ConfigError(std::string("--") + name_of(kind) + ": " + format.name + " holds only " +
                      joined(holds, " and "));
  }
  return kind;
}

/// Refuses options that the content does not go by.
void check_use(const ExportOptions& options, const ExportFormat& format, ProductKind kind) {
  const bool has_elements = format.takes_elements && kind == ProductKind::truth;
  if (!options.catalogues.empty() && !has_elements)
    throw ConfigError(std::string("--catalogue: ") + format.name + " takes no element sets here");
  if (!options.sensor.empty() && (has_elements || kind == ProductKind::tracks))
    throw ConfigError("--sensor: " + std::string(has_elements ? "element sets" : "tracks") +
                      " are of no sensor");
}

/// Path of a catalogue that a scenario names.
std::string path_of(const std::string& named) {
  const char* file = object_catalogue_file(named);
  const std::string path = file ? find_catalogue(file) : named;
  if (path.empty() || !path_exists(path))
    throw ConfigError("--catalogue: the run's catalogue is not found from here, got " +
                      printable(named));
  return path;
}

/// Reads a catalogue of a run. Throws `ConfigError` if the file is not the one that the run read.
CatalogueFile catalogue_of(const RunProducts& run, const RunCatalogue& catalogue) {
  if (catalogue.sha256.empty())
    throw ConfigError(run.directory +
                      "/run.json: catalogue_sha256: is missing: the run was made by an earlier "
                      "version (--catalogue FILE names its element sets)");
  const std::string path = path_of(catalogue.named), text = read_text_file(path);
  if (sha256_hex(text) != catalogue.sha256)
    throw ConfigError(path +
                      ": is not the file that the run read: its SHA-256 is not that in run.json "
                      "(--catalogue FILE names another)");
  return parse_catalogue(text, path);
}

/// Element sets of the objects, as the run takes them: of a number that of the scenario's own
/// object, else of the first catalogue; number 0 does not identify an object.
std::vector<MeanElements> elements_of(const RunProducts& run, const ExportOptions& options) {
  std::vector<MeanElements> all;
  std::set<std::uint32_t> taken;
  for (const RunObject& object : run.own_objects) taken.insert(object.catalogue_number);
  const auto add = [&](CatalogueFile file, const std::vector<std::string>& only) {
    for (MeanElements& e : file.elements) {
      e.name = printable(e.name);
      if (!only.empty() &&
          std::ranges::none_of(only, [&](auto& name) { return is_called(e, name); }))
        continue;
      if (e.catalogue_number == 0 || taken.insert(e.catalogue_number).second) all.push_back(e);
    }
  };
  for (const std::string& path : options.catalogues) add(read_catalogue(path), {});
  if (options.catalogues.empty())
    for (const RunCatalogue& catalogue : run.catalogues)
      add(catalogue_of(run, catalogue), catalogue.only);
  for (const RunObject& object : run.own_objects)
    if (object.elements) all.push_back(*object.elements);
  return all;
}

void write(const ExportedFile& file, fs::path path) {
  if (path.has_parent_path()) make_directories(path.parent_path(), "--out");
  path = file_to_write("--out", path.string());
  if (file.copy_of.empty()) return write_file_whole(path.string(), file.content);
  const std::string partial = WholeFile::partial_of(path.string());
  std::error_code error;
  fs::copy_file(file.copy_of, partial, fs::copy_options::overwrite_existing, error);
  if (!error) fs::rename(partial, path, error);
  if (error) throw Error(path.string() + ": can't be written: " + error.message());
}

fs::path export_kind(const ExportOptions& options, const ExportFormat& format, ProductKind kind) {
  check_use(options, format, kind);
  std::error_code unknown;
  const bool is_file = fs::path(format.file).has_extension();
  if (fs::exists(options.out, unknown) && fs::is_directory(options.out, unknown) == is_file)
    throw ConfigError(std::string("--out: ") + format.name + " is written to a " +
                      (is_file ? "file, got the directory " : "directory, got the file ") +
                      printable(options.out));
  if (is_file && !options.out.empty()) file_to_write("--out", options.out);
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
      if (kind != ProductKind::truth || path_exists(path_in(options.run, run_file::truth)))
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

void add_export_options(CLI::App& command) {
  auto options = std::make_shared<ExportOptions>();
  command.add_option("run", options->run, "directory of a run that has ended")->required();
  command.add_option("--to", options->to, format_help())->required();
  command.add_option("--out", options->out,
                     "file or directory, as the format has it; by default below RUN/export");
  command.add_option("--sensor", options->sensor, "only products of this sensor");
  auto* truth = command.add_flag("--truth", options->truth, "what was, from truth.jsonl");
  command
      .add_flag("--detections", options->detections,
                "what the sensors found, from detections.jsonl")
      ->excludes(truth);
  command
      .add_flag("--tracks", options->tracks, "what the fusion node made of them, from tracks.jsonl")
      ->excludes(truth)
      ->excludes("--detections");
  command.add_option("--catalogue", options->catalogues,
                     "omm: files of element sets instead of those that the scenario names");
  command.callback([options] { run_export(*options); });
}

}  // namespace

Command export_command() {
  return {.group = CommandGroup::frames,
          .summary = "Writes the products of a run in formats of other programs (docs/exchange.md)",
          .add_options = add_export_options};
}

}  // namespace dmise
