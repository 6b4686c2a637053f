#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/frames/geodesy.h"
#include "core/fusion/catalogue_prediction.h"
#include "core/fusion/sensor_frame.h"
#include "core/products/track.h"
#include "core/sky/bodies/shadow.h"

namespace dmise {

struct FusionTrialSettings {
  std::vector<Site> sites;              // sensors there look at the zenith
  double half_angle_rad = 0.0;          // half width of their fields
  double sigma_rad = 0.0;               // error of a detection along each axis
  double detection_probability = 0.9;   // for what is lit and brighter than the limit
  double false_alarms_per_frame = 0.0;  // mean
  double limiting_magnitude = 0.0;
  std::size_t max_per_frame = 1000000;
  std::uint64_t seed = 1;
};

/// A sensor of a trial that may look elsewhere than at the zenith.
struct TrialSensor {
  std::string name;
  Site site;
  double half_angle_rad = 0.0;
  double sigma_rad = 0.0;
  double limiting_magnitude = 0.0;
  std::size_t first_object = 0;  // with which it begins to tell
};

/// What a network of sensors on the ground detects, without pixels: directions with errors of
/// objects on SGP4's paths that the Sun lights, and false alarms.
class FusionTrial {
 public:
  /// Standard magnitudes of objects at 1000 km are drawn between 3 and 9.
  FusionTrial(std::vector<MeanElements> objects, const Clock& clock,
              const FusionTrialSettings& settings);

  /// Frames of all sites with this mid exposure; `number` counts from 1.
  std::vector<SensorFrame> frames(SimTime time, std::uint32_t number);

  /// The frame of one more sensor with a field about `axis` (unit).
  SensorFrame frame_of(const TrialSensor& sensor, const Vec<Gcrs>& axis, SimTime time,
                       std::uint32_t number);

  /// Catalogue number of the object of a detection; 0: of none.
  std::uint32_t truth(const std::string& detection_id) const;
  const std::map<std::string, std::uint32_t>& truths() const { return truth_; }

 private:
  void move(SimTime time);

  std::vector<MeanElements> objects_;
  Clock clock_;
  FusionTrialSettings settings_;
  CataloguePrediction paths_;
  bool moved_ = false;
  Rotation<Gcrs, Itrs> gcrs_from_itrs_;
  Vec<Gcrs> sun_m_;
  std::optional<EarthShadow> shadow_;
  std::vector<double> lit_;  // by object, now; -1: not known
  std::map<std::string, std::uint32_t> truth_;
};

/// How well tracks divide detections among objects.
struct TrackingScore {
  std::size_t tracks = 0;      // that were ever confirmed
  std::size_t of_noise = 0;    // tracks with mostly false alarms
  std::size_t associated = 0;  // detections of confirmed tracks
  std::size_t pure = 0;        // detections of the object that a track has most of
  std::size_t objects = 0;     // with at least `least` detections
  std::size_t found = 0;       // with a confirmed track

  double purity() const { return associated ? double(pure) / double(associated) : 1.0; }
  double completeness() const { return objects ? double(found) / double(objects) : 1.0; }
};

/// Gathers tracks as they are published.
class TrackLedger {
 public:
  void add(const std::vector<Track>& tracks);
  /// Objects count that have `least` detections or more.
  TrackingScore score(const FusionTrial& trial, std::size_t least) const;

 private:
  struct Entry {
    bool confirmed = false;
    std::vector<std::string> detections;
  };
  std::map<std::uint32_t, Entry> entries_;
};

}  // namespace dmise
