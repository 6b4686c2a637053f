#pragma once
#include <array>
#include <string>
#include <string_view>

// The files of a run's directory: each name once, for those who write, read, list and remove them.
namespace dmise {

struct RunFile {
  const char* name;
  const char* why_missing;  // what a run without it lacks
};

namespace run_file {
// What ran and how it ended; written at the start, and whole at the end.
inline constexpr RunFile record{"run.json", "no run, or one that has not ended"};
// Lines of all sensors by (time, sensor, index); those of one sensor in its own directory.
inline constexpr RunFile frames{"frames.jsonl", "the run has no frames"};
inline constexpr RunFile detections{"detections.jsonl", "the run has no detections"};
inline constexpr RunFile truth{"truth.jsonl", "the scenario says output: {truth: false}"};
// Seconds and levels of frames, in a sensor's directory only.
inline constexpr RunFile costs{"cost.jsonl", "the sensor has made no frame"};
inline constexpr RunFile tracks{"tracks.jsonl", "the scenario has no fusion"};
inline constexpr RunFile orbits{"orbits.jsonl", "the scenario's fusion has no keep_orbits"};
inline constexpr RunFile breakups{"breakups.jsonl", "the scenario's fusion has no keep_orbits"};
inline constexpr RunFile tasks{"tasks.jsonl", "the scenario has no cued sensor"};
inline constexpr RunFile positions_csv{"positions.csv", "the scenario asks for no positions"};
inline constexpr RunFile positions{"positions.jsonl", "the scenario asks for no positions"};
inline constexpr RunFile night{"night.jsonl", "the run is not one of `dmise observatory`"};
inline constexpr RunFile tracks_chart{"tracks.svg", "the scenario has no fusion"};
inline constexpr RunFile page{"index.html", "the report was not written"};

/// Products beside run.json and those in the directories of nodes.
inline constexpr std::array products{detections, truth,    frames, positions_csv, positions, tracks,
                                     orbits,     breakups, tasks,  tracks_chart,  page,      night};
/// Tables that a sensor appends to in its own directory: that of frames last, for a frame is done
/// once it stands there.
inline constexpr std::array of_sensor{detections, truth, costs, frames};
/// Those of all sensors, which are merged into one.
inline constexpr std::array merged{detections, truth, frames};
}  // namespace run_file

/// Endings of the files of one frame, frame-000001.fits and so on.
inline constexpr std::array<const char*, 8> frame_endings{
    ".fits",         "-sources.fits", "-background.fits", "-noise.fits",
    "-radiance.exr", ".png",          "-marked.png",      ".stars.csv"};

/// Whether a sensor writes a file of this name into its directory, perhaps a part of it.
bool is_file_of_sensor(std::string_view name);

std::string path_in(const std::string& directory, const RunFile& file);
/// The path of a file that is there. Throws `ConfigError` "PATH: is missing: REASON".
std::string existing_path(const std::string& directory, const RunFile& file);

}  // namespace dmise
