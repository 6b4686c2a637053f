#pragma once
#include <string>
#include <vector>

namespace dmise {

/// Root of the installation or checkout: `$DMISE_HOME`, else found upwards from this code's file,
/// the running program or a module of Python.
std::string home_directory();

/// Looks for `name` as a path beside `from_file` and as given, then as a preset
/// `<home>/launch/<kind>/<name>.yaml`. Empty if there is none.
std::string find_preset(const std::string& kind, const std::string& name,
                        const std::string& from_file);
std::vector<std::string> preset_names(const std::string& kind);

/// Looks for a file named by a scenario beside the scenario and as given; empty if there is none.
std::string find_beside(const std::string& name, const std::string& from_file);

/// The catalogue of objects of the shipped scenarios; "gpredict" is its former name.
inline constexpr const char* default_object_catalogue = "demo";

/// Returns the file of a catalogue of objects by name, for `find_catalogue`; null for an unknown
/// name.
const char* object_catalogue_file(const std::string& name);

/// Path of a catalogue of launch/catalogues, or of one that `dmise catalogue fetch` has made. Empty
/// if absent.
std::string find_catalogue(const std::string& file_name);

/// Returns the message about a catalogue of launch/catalogues that is absent.
std::string missing_catalogue(const std::string& file_name);

}  // namespace dmise
