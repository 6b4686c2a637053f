#pragma once
#include <string>

namespace dmise {

/// The user's list of directories whose scenarios may start programs: one absolute path a line,
/// after # comments. Empty if the user has no home.
std::string trusted_directories_file();

/// Why the file `list` does not trust the scenarios of `directory`, for messages; empty if it does.
/// It does if it has the directory or one above it, and if these, all between them, the file and
/// its directory belong to the user and nobody else may write to them. Throws `ConfigError`
/// "PATH:line: reason" for a path that is not absolute.
std::string why_not_trusted(const std::string& directory, const std::string& list);

}  // namespace dmise
