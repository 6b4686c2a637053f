#pragma once
#include <map>
#include <span>
#include <string>

namespace dmise {

/// A real frame and its camera as published.
struct RealFrame {
  const char* name;  // in figures
  const char* file;  // in DATA/frames
  const char* camera;
  const char* scenario;  // what the exposure is checked with; null: nothing is predicted
  std::map<std::string, std::string> stated;  // facts that its header lacks, by keyword
  // Columns without light, from 0, by which the bias is measured.
  int first_dark_column = 0, dark_columns = 0;
  double e_per_count = 0.0;  // electrons of a count before calibration, if the frame is calibrated
  const char* calibration = "";  // keyword of nanomaggies of a count
  int wanted_streaks = 0;
  const char* about;
};

std::span<const RealFrame> real_frames();

}  // namespace dmise
