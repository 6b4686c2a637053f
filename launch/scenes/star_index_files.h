#pragma once
#include <string>

namespace dmise {

/// Makes the index of Tycho-2 with the stars of `kstars`, `tycho2.stars`, in a directory and
/// returns its path. `from`: a URL or path of deepstars.dat or of an archive with it; empty: PyPI.
/// `to`: empty: the checkout's build/data, else this user's data. Throws `ConfigError` if it can't
/// be fetched, is not the file that was tested, or can't be written.
std::string fetch_tycho2(const std::string& from, const std::string& to);

/// Indexes a catalogue of any size and returns how many stars it has. Throws `ConfigError`.
std::size_t index_stars(const std::string& from, const std::string& to);

}  // namespace dmise
