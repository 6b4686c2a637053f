#pragma once
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace dmise {

/// A benchmark: prints its results and returns an exit code.
struct Bench {
  std::string name;
  std::string what;
  std::function<int(bool json)> run;
  std::function<void(CLI::App&)> add_options = {};  // additional options; may be empty
};

/// All benchmarks. To add one: write bench/bench_NAME.cpp, declare and list it in benches.cpp.
std::vector<Bench> benches();

}  // namespace dmise
