#include "sensors/survey/survey_summary.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/quantile.h"

namespace dmise {
namespace {

/// The smallest value that a share of the values does not exceed; 0 without any.
double not_exceeded_by(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  return value_of_rank(values,
                       std::size_t(std::max(0.0, std::ceil(share * double(values.size())) - 1.0)));
}

/// What is known of one object in a span of time: the passes of all sensors.
class Sums {
 public:
  explicit Sums(std::size_t shells) : gaps_s_(shells + 1) { out.shells.resize(shells); }

  /// `passes`: of one object, by time of their beginning.
  void take(std::size_t shell, const std::vector<const SurveyPass*>& passes) {
    if (passes.empty()) return;
    double log_miss = 0.0, expected = 0.0;
    std::optional<SimTime> visited;
    std::size_t visits = 0;
    for (const SurveyPass* p : passes) {
      log_miss += p->log_miss;
      expected += p->expected;
      if (-std::expm1(p->log_miss) < 0.5) continue;
      const double gap_s = visited ? (p->first - *visited).seconds() : 1e300;
      if (gap_s > pass_gap_s) {
        ++visits;
        if (visited) {
          gaps_s_[shell].push_back(gap_s);
          gaps_s_.back().push_back(gap_s);
        }
      }
      visited = visited ? std::max(*visited, p->last) : p->last;
    }
    for (ShellSummary* s : {&out.shells[shell], &out.all}) {
      ++s->covered;
      s->detected -= std::expm1(log_miss);
      s->detections += expected;
      s->visits += visits;
    }
  }

  NightSummary finish(const Shells& shells) {
    for (std::size_t k = 0; k <= out.shells.size(); ++k) {
      ShellSummary& s = k < out.shells.size() ? out.shells[k] : out.all;
      s.objects = k < out.shells.size() ? shells.shells[k].objects : shells.of_object.size();
      s.revisits = {gaps_s_[k].size(), not_exceeded_by(gaps_s_[k], 0.5),
                    not_exceeded_by(gaps_s_[k], 0.9)};
    }
    return std::move(out);
  }

  NightSummary out;

 private:
  std::vector<std::vector<double>> gaps_s_;  // by shell, then of all
};

/// Totals of one sensor over the passes and exposures of some night, or of all.
SensorTotals totals_of(const SensorSurvey& survey, double cadence_s, std::optional<int> night) {
  SensorTotals totals;
  const auto counts = [&](SimTime t) { return !night || night_of(t) == *night; };
  for (const auto& e : survey.exposures) totals.exposures += counts(e.middle);
  totals.hours = double(totals.exposures) * cadence_s / 3600.0;
  for (std::size_t k = 0; k < survey.passes.size();) {
    const std::uint32_t object = survey.passes[k].object;
    double log_miss = 0.0;
    bool seen = false;
    for (; k < survey.passes.size() && survey.passes[k].object == object; ++k) {
      if (!counts(survey.passes[k].first)) continue;
      seen = true;
      log_miss += survey.passes[k].log_miss;
      totals.detections += survey.passes[k].expected;
    }
    totals.covered += seen;
    totals.detected -= std::expm1(log_miss);
  }
  return totals;
}

}  // namespace

SurveySummary summarise_survey(const std::vector<SensorSurvey>& surveys, const Shells& shells,
                               const std::vector<double>& cadence_s, int nights) {
  std::vector<std::vector<const SurveyPass*>> of_object(shells.of_object.size());
  for (const auto& survey : surveys)
    for (const auto& pass : survey.passes) of_object[pass.object].push_back(&pass);
  Sums run(shells.shells.size());
  std::vector<Sums> of_night(std::size_t(nights), Sums(shells.shells.size()));
  for (std::size_t i = 0; i < of_object.size(); ++i) {
    auto& passes = of_object[i];
    std::stable_sort(passes.begin(), passes.end(),
                     [](const auto* a, const auto* b) { return a->first < b->first; });
    run.take(shells.of_object[i], passes);
    for (std::size_t first = 0; first < passes.size();) {
      const int night = night_of(passes[first]->first);
      std::vector<const SurveyPass*> some;
      for (; first < passes.size() && night_of(passes[first]->first) == night; ++first)
        some.push_back(passes[first]);
      of_night[std::size_t(std::min(night, nights - 1))].take(shells.of_object[i], some);
    }
  }
  SurveySummary summary{.nights = {}, .run = run.finish(shells)};
  for (int night = 0; night < nights; ++night)
    summary.nights.push_back(of_night[std::size_t(night)].finish(shells));
  for (std::size_t k = 0; k < surveys.size(); ++k) {
    summary.run.sensors.push_back(totals_of(surveys[k], cadence_s[k], std::nullopt));
    for (int night = 0; night < nights; ++night)
      summary.nights[std::size_t(night)].sensors.push_back(
          totals_of(surveys[k], cadence_s[k], night));
  }
  return summary;
}

std::vector<CandidateSite> candidate_sites(const std::vector<SensorConfig>& sensors) {
  std::vector<CandidateSite> sites;
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    const auto* site = std::get_if<SiteConfig>(&sensors[k].place);
    if (!site) continue;
    const auto same = std::find_if(sites.begin(), sites.end(), [&](const CandidateSite& other) {
      const auto& o = std::get<SiteConfig>(sensors[other.sensors.front()].place);
      const bool same_meridian =
          std::abs(o.latitude_deg) == 90.0 ||
          std::remainder(o.longitude_deg - site->longitude_deg, 360.0) == 0.0;
      return o.latitude_deg == site->latitude_deg && same_meridian && o.height_m == site->height_m;
    });
    if (same != sites.end())
      same->sensors.push_back(k);
    else
      sites.push_back({sensors[k].name, {k}});
  }
  return sites;
}

SiteMisses misses_of(const std::vector<SensorSurvey>& surveys,
                     const std::vector<CandidateSite>& sites, std::size_t objects, int nights) {
  SiteMisses misses{
      .sites = sites.size(), .cells = objects * std::size_t(nights), .nights = nights};
  misses.log_miss.assign(misses.sites * misses.cells, 0.0);
  misses.always.assign(misses.cells, 0.0);
  std::vector<bool> of_site(surveys.size(), false);
  const auto add = [&](const SensorSurvey& survey, double* row) {
    for (const auto& pass : survey.passes) {
      const int night = std::min(night_of(pass.first), nights - 1);
      row[std::size_t(night) * objects + pass.object] += pass.log_miss;
    }
  };
  for (std::size_t s = 0; s < sites.size(); ++s)
    for (const std::size_t k : sites[s].sensors) {
      add(surveys[k], misses.log_miss.data() + s * misses.cells);
      of_site[k] = true;
    }
  for (std::size_t k = 0; k < surveys.size(); ++k)
    if (!of_site[k]) add(surveys[k], misses.always.data());
  return misses;
}

}  // namespace dmise
