#pragma once

namespace CLI {
class App;
}

namespace dmise {

/// A field of 1 deg of an index of many stars: milliseconds, and the memory that the index takes of
/// a process; and a field of 0.5 deg of synthetic stars in the Milky Way.
int bench_stars(bool json);
void add_stars_options(CLI::App& app);

}  // namespace dmise
