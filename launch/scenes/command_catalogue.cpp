#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/base/formatted.h"
#include "core/orbit/elements/catalogue.h"
#include "core/orbit/elements/element_text.h"
#include "core/orbit/elements/facts_import.h"
#include "core/orbit/sgp4/catalogue_report.h"
#include "core/orbit/sgp4/synthetic_catalogue.h"
#include "core/propagation/catalogue_states.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/command/notes.h"
#include "launch/scenes/star_index_files.h"

namespace dmise {
namespace {

struct FileOptions {
  std::string path;  // "-" is standard input
  bool lenient = false;
};

CatalogueFile read(const FileOptions& options) {
  const CatalogueOptions how{.lenient = options.lenient};
  if (options.path == "-") return parse_catalogue(read_standard_input(), "standard input", how);
  return read_catalogue(options.path, how);
}

void add_file_options(CLI::App& command, FileOptions& options) {
  command
      .add_option("file", options.path,
                  "TLE, 3LE, gpredict or OMM (JSON, CSV, XML, KVN), gzip too; - is standard input")
      ->required();
  command.add_flag(
      "--lenient", options.lenient,
      "accept lines with a wrong or missing checksum or truncated after the last element, "
      "with a warning each");
}

struct StatesOptions {
  FileOptions file;
  std::string at, frame, earth_orientation;
};

/// A Julian date in plain decimals such as 2458837.5, or an ISO 8601 time.
Utc parse_instant(const std::string& text) {
  double jd = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), jd);
  if (error == std::errc{} && end == text.data() + text.size()) {
    if (!std::isfinite(jd)) throw ConfigError("--at: must be a finite Julian date, got " + text);
    if (jd < 2.3e6 || jd > 2.6e6) throw ConfigError("--at: Julian date out of range, got " + text);
    if (text.find_first_of("eE") != std::string::npos)
      throw ConfigError("--at: must be a Julian date without an exponent, got " + text);
    // Parse digits before and after the point separately, to keep precision.
    const auto point = text.find('.');
    const double days = std::strtod(text.substr(0, point).c_str(), nullptr);
    const double part =
        point == std::string::npos ? 0.0 : std::strtod(("0" + text.substr(point)).c_str(), nullptr);
    return part >= 0.5 ? Utc{days + 0.5, part - 0.5} : Utc{days - 0.5, part + 0.5};
  }
  try {
    return parse_utc(text);
  } catch (const ConfigError&) {
    throw ConfigError(
        "--at: must be a UTC time such as 2018-01-21T00:30:00Z or a Julian date, got " + text);
  }
}

void need_elements(const CatalogueFile& catalogue) {
  if (catalogue.elements.empty())
    throw ConfigError(catalogue.refused.empty()
                          ? catalogue.source + ": contains no element sets"
                          : catalogue.describe(catalogue.refused[0]) + " (no element set is left)");
}

/// The report is printed before the refusal, because it says what was found instead.
void print_info(const FileOptions& options) {
  const auto catalogue = read(options);
  std::fputs(format(report_of(catalogue)).c_str(), stdout);
  need_elements(catalogue);
}

StateAxes axes_of(const std::string& frame) {
  return frame == "teme" ? StateAxes::teme : frame == "gcrs" ? StateAxes::gcrs : StateAxes::itrs;
}

void print_states(const StatesOptions& options) {
  const Utc utc = parse_instant(options.at);
  const auto catalogue = read(options.file);
  need_elements(catalogue);
  for (const auto& problem : catalogue.refused)
    print_note(catalogue.describe(problem) + " (left out)");
  for (const auto& problem : catalogue.warnings) print_note(catalogue.describe(problem));
  const auto iers = options.earth_orientation.empty()
                        ? nullptr
                        : std::make_shared<const IersTable>(
                              IersTable::read_finals2000a(options.earth_orientation));
  const StateAxes axes = axes_of(options.frame);
  if (axes != StateAxes::teme)  // which needs no Earth
    for (const auto& warning : Clock(utc, iers).warnings({0})) print_note(warning);
  Threads threads(1);
  const auto states = states_of(catalogue.elements, std::span(&utc, 1), axes, iers, threads);
  std::puts("id,code,x_km,y_km,z_km,vx_km_s,vy_km_s,vz_km_s");
  std::string row;
  for (std::size_t i = 0; i < states.objects; ++i) {
    row = std::to_string(catalogue.elements[i].catalogue_number) + "," +
          std::to_string(states.code[i]);
    for (const auto* vectors : {&states.position_m, &states.velocity_m_per_s})
      for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
        row += states.code[i] != 0 ? "," : "," + shortest_text((*vectors)[k] / 1e3);
    std::puts(row.c_str());
  }
}

struct SynthOptions {
  std::size_t objects = 18470;
  std::uint64_t seed = 1;
  std::string format;  // empty: 3le up to its largest number
};

void print_synthetic(const SynthOptions& options) {
  constexpr std::size_t most_in_a_tle = 339999;  // limit of Alpha-5
  const bool omm =
      options.format.empty() ? options.objects > most_in_a_tle : options.format == "omm";
  if (!omm && options.objects > most_in_a_tle)
    throw ConfigError("--objects: a TLE has numbers up to 339999; use --format omm, got " +
                      std::to_string(options.objects));
  // In chunks: a million objects take no more memory than a few thousand.
  constexpr std::size_t piece = 4096;
  for (std::size_t first = 0; first < options.objects; first += piece) {
    const auto elements = synthetic_catalogue({.objects = std::min(piece, options.objects - first),
                                               .first = first,
                                               .seed = options.seed});
    const std::string text = omm ? format_omm_csv(elements) : format_3le(elements);
    const std::size_t begin = omm && first > 0 ? text.find('\n') + 1 : 0;  // one header
    if (std::fwrite(text.data() + begin, 1, text.size() - begin, stdout) != text.size() - begin)
      throw Error("catalogue synth: could not write to standard output");
  }
}

struct FactsOptions {
  std::string path, out;
  std::string kind = "diameter", unit;  // what sizes are; no unit: m, or m2
  FactsColumns columns;
};

SizeKind kind_of(const std::string& kind) {
  return kind == "radius" ? SizeKind::radius : kind == "rcs" ? SizeKind::rcs : SizeKind::diameter;
}

SizeUnit unit_of(const std::string& unit, SizeKind kind) {
  if (unit.empty()) return kind == SizeKind::rcs ? SizeUnit::m2 : SizeUnit::m;
  return unit == "cm"     ? SizeUnit::cm
         : unit == "mm"   ? SizeUnit::mm
         : unit == "m2"   ? SizeUnit::m2
         : unit == "dBsm" ? SizeUnit::dbsm
                          : SizeUnit::m;
}

/// Writes what a table says of sizes as a scenario's `facts`.
void import_table(const FactsOptions& options) {
  constexpr std::size_t most_named = 20;
  const std::string text =
      options.path == "-" ? read_standard_input() : read_text_file(options.path);
  FactsColumns columns = options.columns;
  columns.kind = kind_of(options.kind);
  columns.unit = unit_of(options.unit, columns.kind);
  const ImportedFacts imported =
      import_facts(text, options.path == "-" ? "standard input" : options.path, columns);
  const auto& [source, facts, refused] = imported.file;
  for (std::size_t i = 0; i < std::min(refused.size(), most_named); ++i)
    print_note(source + ":" + std::to_string(refused[i].line) + ": " + refused[i].reason +
               " (left out)");
  print_note(formatted("%zu rows: facts of %zu objects, %zu unknown, %zu left out", imported.rows,
                       facts.size(), imported.unknown, refused.size()));
  if (facts.empty()) throw ConfigError(source + ": nothing is known of any object");
  const std::string csv = facts_csv(imported.file);
  if (!options.out.empty())
    write_file_whole(options.out, csv);
  else if (std::fwrite(csv.data(), 1, csv.size(), stdout) != csv.size())
    throw Error("catalogue facts: could not write to standard output");
}

void add_facts_command(CLI::App& command) {
  auto options = std::make_shared<FactsOptions>();
  FactsColumns& columns = options->columns;
  auto* facts = command.add_subcommand(
      "facts", "Makes a scenario's `facts` (sizes, albedos) of somebody's table in CSV");
  facts->add_option("file", options->path, "CSV with a header, gzip too; - is standard input")
      ->required();
  facts->add_option("--id", columns.id, "column of catalogue numbers")->capture_default_str();
  facts->add_option("--size", columns.size, "column of sizes");
  facts->add_option("--is", options->kind, "what sizes are: radius, diameter or rcs")
      ->capture_default_str()
      ->check(one_of({"radius", "diameter", "rcs"}));
  facts
      ->add_option("--unit", options->unit,
                   "m, cm or mm (m); of radar cross-sections m2 or dBsm (m2)")
      ->check(one_of({"m", "cm", "mm", "m2", "dBsm"}));
  facts->add_option("--length", columns.dimensions[0], "column of lengths, in place of a size");
  facts->add_option("--width", columns.dimensions[1], "column of widths");
  facts->add_option("--height", columns.dimensions[2], "column of heights");
  facts->add_option("--albedo", columns.albedo, "column of albedos");
  facts->add_option("--magnitude", columns.standard_magnitude,
                    "column of standard magnitudes: V at 1000 km, half lit");
  facts->add_option("--out", options->out, "file; without it standard output");
  facts->callback([options] { import_table(*options); });
}

/// What is done with catalogues of stars.
void add_star_commands(CLI::App& command) {
  struct Files {
    std::string from, to;
  };
  auto fetched = std::make_shared<Files>();
  auto* fetch = command.add_subcommand(
      "fetch", "Fetches Tycho-2 (stars to V = 11), joins it with kstars and indexes both");
  fetch->add_option("name", "tycho2")->required()->check(one_of({"tycho2"}));
  fetch->add_option("--from", fetched->from,
                    "URL or path of deepstars.dat, or of an archive (.deb, .tar.gz) that holds it; "
                    "without it fchart3 of PyPI");
  fetch->add_option("--to", fetched->to,
                    "directory; without it build/data of the checkout, else ~/.local/share/dmise");
  fetch->callback(
      [fetched] { std::printf("%s\n", fetch_tycho2(fetched->from, fetched->to).c_str()); });

  auto indexed = std::make_shared<Files>();
  auto* index = command.add_subcommand(
      "index", "Makes the index of a large catalogue of stars, for `stars: {catalogue: OUT}`");
  index->add_option("file", indexed->from, "any catalogue of stars that a scenario may name")
      ->required();
  index->add_option("--out", indexed->to, "the index")->required();
  index->callback([indexed] {
    std::printf("%s: %zu stars\n", indexed->to.c_str(), index_stars(indexed->from, indexed->to));
  });
}

void add_catalogue_options(CLI::App& command) {
  command.require_subcommand(1);
  add_star_commands(command);
  add_facts_command(command);
  auto options = std::make_shared<StatesOptions>();
  auto info_options = std::make_shared<FileOptions>();
  auto* info =
      command.add_subcommand("info", "Content of a file: objects, orbits, epochs, refused records");
  add_file_options(*info, *info_options);
  info->callback([info_options] { print_info(*info_options); });

  auto synthetic = std::make_shared<SynthOptions>();
  auto* synth = command.add_subcommand(
      "synth", "Prints a synthetic population (constellations, GEO belt, Molniya, debris)");
  synth->add_option("--objects", synthetic->objects, "number of objects")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  synth->add_option("--seed", synthetic->seed, "seed of the random numbers")
      ->capture_default_str()
      ->check(seed_range());
  synth
      ->add_option("--format", synthetic->format,
                   "3le, or omm (CSV); default omm above 339999 objects, the limit of a TLE")
      ->check(one_of({"3le", "omm"}));
  synth->callback([synthetic] { print_synthetic(*synthetic); });

  auto* states =
      command.add_subcommand("states", "States of all objects at one time, as CSV (km, km/s)");
  add_file_options(*states, options->file);
  states->add_option("--at", options->at, "UTC (ISO 8601) or Julian date")->required();
  states->add_option("--frame", options->frame, "teme, gcrs or itrs")
      ->default_val("teme")
      ->check(one_of({"teme", "gcrs", "itrs"}));
  states->add_option("--earth-orientation", options->earth_orientation,
                     "IERS finals file; without it UT1 equals UTC and there is no polar motion");
  states->callback([options] { print_states(*options); });
}

}  // namespace

Command catalogue_command() {
  return {.group = CommandGroup::predictions,
          .summary =
              "Inspects a catalogue of objects, makes one, or computes its states; indexes stars",
          .details =
              "Element sets: content of a file, states at a time; sizes of objects. Stars: fetch, "
              "index",
          .add_options = add_catalogue_options};
}

}  // namespace dmise
