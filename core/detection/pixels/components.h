#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/detection/pixels/background.h"
#include "core/detection/pixels/filtered_frame.h"

namespace dmise {

/// Pixels [first_x, last_x] of one row above the threshold.
struct Run {
  int y = 0, first_x = 0, last_x = 0;
};

/// Connected pixels (8-connected), as runs by rising row and column.
struct Component {
  std::vector<Run> runs;
  int min_x = 0, max_x = 0, min_y = 0, max_y = 0;
  int pixels = 0;
  float peak_snr = 0.0f;  // by the matched filter
  int peak_x = 0, peak_y = 0;
};

/// Convolves the background-subtracted frame with a Gaussian of `sigma_px` (the matched filter of a
/// point source, in units of its noise), keeps pixels above `low` and returns the connected
/// components with a pixel above `high`, by rising (row, column) of their first pixel. `filtered`,
/// if not null, is of the frame's size and gets what the filter returned. Works in bands of rows,
/// to save memory. Equal for any number of threads.
std::vector<Component> find_components(const CountImage& counts, const Background& background,
                                       double sigma_px, double low, double high, Threads& threads,
                                       FilteredFrame* filtered = nullptr);

/// Returns the connected parts of a component that are above `low` in a filtered frame and have a
/// pixel above `high` there, in the same order.
std::vector<Component> parts_of(const Component& component, const FilteredFrame& frame, double low,
                                double high);

/// Sum of squares of the unit-sum Gaussian on the pixel grid: a point source of flux F in white
/// noise s has the matched-filter SNR F sqrt(this) / s.
double kernel_square_sum(double sigma_px);

/// Electrons of a point at the limiting magnitude, with pixels of `noise_e` rms: its peak in the
/// frame filtered for points is the threshold `detection_limits::seed_snr` of the background's
/// noise, so half of such points exceed it. `dmise check`, `explain` and reports of frames share
/// this definition.
double limiting_point_e(double noise_e, double sigma_px);

}  // namespace dmise
