#pragma once
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "core/effects/effects.h"
#include "core/run/run_files.h"
#include "core/time/clock.h"
#include "sensors/frame/cost_lines.h"
#include "sensors/frame/frame_pipeline.h"

namespace dmise {

/// Writes the products of one sensor into its own directory: frame-000001.fits, planes and pictures
/// whole or not at all, then its lines in frames.jsonl, detections.jsonl, truth.jsonl. A frame is
/// done when its line in frames.jsonl is whole. Nothing here depends on the wall clock but
/// cost.jsonl.
class ProductWriter {
 public:
  ProductWriter(std::string directory, const OutputConfig& output, Clock clock);

  ~ProductWriter();
  ProductWriter(const ProductWriter&) = delete;
  ProductWriter& operator=(const ProductWriter&) = delete;

  void write(const FrameProducts& frame);
  /// Removes the lines of frames after `last` and lines that an earlier process left incomplete.
  /// Returns how many detections are left.
  long keep_frames(std::uint32_t last) const;

 private:
  std::string frame_path(std::uint32_t frame, const char* ending) const;
  void write_planes(const FrameProducts& frame) const;
  void append(const RunFile& table, const std::string& lines) const;

  std::string directory_;
  OutputConfig output_;
  Clock clock_;
  CostLines costs_;
};

}  // namespace dmise
