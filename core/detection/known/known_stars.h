#pragma once
#include <utility>
#include <vector>

#include "core/detection/known/catalogue_sky.h"
#include "core/detection/light/trail_fit.h"
#include "core/detection/pixels/bit_mask.h"

namespace dmise {

/// The stars of a catalogue that a frame shows, with which its sources are compared.
class KnownStars {
 public:
  /// A star where the frame has it, and the most light that may come from it.
  struct Star {
    PixelPosition place;
    double max_e = 0.0;
  };

  /// `lit`: the pixels with the stars' light. `sky` and `header` must outlive it.
  KnownStars(const CatalogueSky& sky, const FrameHeader& header, std::vector<Star> stars,
             BitMask lit);

  /// Stars that the frame itself has shown, and that are subtracted from it: a catalogue would know
  /// no others.
  KnownStars(std::vector<Trail> subtracted, BitMask lit)
      : subtracted_(std::move(subtracted)), lit_(std::move(lit)) {}

  bool lights(int x, int y) const { return lit_.at(x, y); }
  const BitMask& lit() const { return lit_; }
  const std::vector<Trail>& subtracted() const { return subtracted_; }
  /// Whether a star of this light at a place would be in the catalogue.
  bool would_know(PixelPosition place, double flux_e) const;
  /// Whether a star within a distance of a place may be as bright as `flux_e`.
  bool may_be_at(PixelPosition place, double within_px, double flux_e) const;

 private:
  const CatalogueSky* sky_ = nullptr;  // null: there is no catalogue
  const FrameHeader* header_ = nullptr;
  std::vector<Star> stars_;  // by rising row
  std::vector<Trail> subtracted_;
  BitMask lit_;
};

}  // namespace dmise
