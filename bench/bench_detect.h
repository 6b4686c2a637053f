#pragma once

namespace CLI {
class App;
}

namespace dmise {

void add_detect_options(CLI::App& command);

/// How the detector compares to the ideal matched filter, in simulated frames with noise, stars,
/// points and streaks of known SNR: time and memory of a frame, false alarms, the SNR at which half
/// are found minus the threshold, error over the Cramer-Rao bound, NEES and bias. Prints one line
/// per value, JSON or text. Returns an exit code.
int bench_detect(bool json);

}  // namespace dmise
