#pragma once
#include <optional>
#include <string>

#include "launch/dataset/dataset_directory.h"

// A complete data set that gets more seeds becomes an unfinished one of all seeds, whose archives
// are there. What it then lacks is made as that of any unfinished one, so its bytes are those of a
// data set that is made at once.
namespace dmise {

/// Bytes that a file of a data set may have.
inline constexpr std::size_t any_size = std::size_t(1) << 40;
/// First fields of plan.json and dataset.json.
std::string dataset_head(const DatasetPlan& plan);
/// First line of the text files of parts.
std::string digest_line(const DatasetPlan& plan);
/// Begin of the lines of those files, before an object of JSON.
inline constexpr std::string_view image_mark = "image ", annotation_mark = "annotation ";

/// `plan` with the seeds that a plan.json or dataset.json has; empty if the file is of another
/// scenario or program.
std::optional<DatasetPlan> recorded_plan(const std::string& text, const DatasetPlan& plan);

/// The data set that is in a directory when the seeds of `plan` are in it as well: `plan` if there
/// is none, or one of another scenario. Throws `ConfigError` if the seeds do not join those that
/// are there, for another number of seeds in an archive, and for an unfinished data set of others.
DatasetPlan grown_plan(const std::string& path, DatasetPlan plan);

/// Writes into parts/ what dataset.json and coco.json of the complete data set `old` say of its
/// full archives. Throws `Error` if they are not as they were written.
void restore_parts(const std::string& path, const DatasetPlan& old);

}  // namespace dmise
