#pragma once
#include <limits>
#include <string>

namespace dmise {

/// Bounds of the differences between one exposure and its reference, in the units in which frames
/// are used.
struct ErrorBound {
  double photometry_mag = 0.0;    // worst source in the frame
  double position_px = 0.0;       // worst centroid of a source
  double background_sigma = 0.0;  // worst pixel between sources, in units of its noise
  double noise = 0.0;             // worst pixel, relative

  ErrorBound& operator+=(const ErrorBound& o) {
    photometry_mag += o.photometry_mag;
    position_px += o.position_px;
    background_sigma += o.background_sigma;
    noise += o.noise;
    return *this;
  }
  friend ErrorBound operator+(ErrorBound a, const ErrorBound& b) { return a += b; }
  bool within(const ErrorBound& budget) const {
    return photometry_mag <= budget.photometry_mag && position_px <= budget.position_px &&
           background_sigma <= budget.background_sigma && noise <= budget.noise;
  }
  bool operator==(const ErrorBound&) const = default;
};

/// The members of an ErrorBound, with their keys in YAML and JSON.
struct ErrorKind {
  const char* key;
  const char* unit;
  double ErrorBound::*value;
  const char* meaning;
};
inline constexpr ErrorKind error_kinds[] = {
    {"photometry_mag", "mag", &ErrorBound::photometry_mag,
     "Greatest error of the brightness of a source"},
    {"position_px", "px", &ErrorBound::position_px, "Greatest error of the position of a source"},
    {"background_sigma", "sigma", &ErrorBound::background_sigma,
     "Greatest error of the background between sources, in its noise"},
    {"noise", "relative", &ErrorBound::noise, "Greatest error of the noise of a pixel"}};

inline constexpr double unbounded = std::numeric_limits<double>::infinity();
/// An effect that must not be left out has this error.
inline constexpr ErrorBound not_bounded{unbounded, unbounded, unbounded, unbounded};

/// What a scenario asks of its frames: the cheapest plan within a budget of errors, or the most
/// accurate one for a time.
struct Accuracy {
  std::string name;  // "draft", "standard", "reference", "budget", "seconds"; empty: no plan
  ErrorBound budget{};
  double seconds_per_frame = unbounded;

  bool is_planned() const { return !name.empty(); }
  bool operator==(const Accuracy&) const = default;
};

inline constexpr ErrorBound draft_budget{0.1, 0.5, 1.0, 0.1};
inline constexpr ErrorBound standard_budget{0.01, 0.05, 0.1, 0.01};

inline Accuracy draft_accuracy() { return {"draft", draft_budget}; }
inline Accuracy standard_accuracy() { return {"standard", standard_budget}; }
inline Accuracy reference_accuracy() { return {"reference"}; }

}  // namespace dmise
