#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/discrimination/discrimination_design.h"
#include "core/discrimination/material_likelihood.h"
#include "core/discrimination/run_signatures.h"
#include "core/image/charts/chart.h"

namespace dmise {

/// Result of a run for one object: ratios of the light in each band to that in the first.
struct ObjectSignature {
  std::string object;
  std::size_t samples = 0;
  std::vector<Measured> summed;      // light in each band
  std::vector<Measured> ratios;      // all samples together, by band from the second on
  std::vector<double> scatter;       // standard deviation of the samples' ratios, likewise
  std::vector<double> sample_sigma;  // root mean square of what each sample states for it
  std::vector<MaterialFit> fits;     // materials that fit `summed`, most probable first
};

/// Signatures of all objects. `confusion` counts which material each sample of an object of known
/// material is taken for. Samples without light in the first band have no ratio.
struct RunDiscrimination {
  RunSpectra spectra;
  std::vector<MaterialSignature> materials;
  std::vector<ObjectSignature> objects;
  ConfusionMatrix confusion;
};

/// `known`: object to material. Throws `Error` for a known object that was neither
/// measured nor left out, and for a known material that is not among `materials`.
RunDiscrimination discriminate(RunSpectra spectra, const std::vector<MaterialSignature>& materials,
                               const std::map<std::string, std::string>& known);

std::string discrimination_table(const RunDiscrimination& run);
std::string discrimination_json(const RunDiscrimination& run);

std::string design_table(const DiscriminationDesign& design);
std::string design_json(const DiscriminationDesign& design);
/// Exposure against distance.
Chart range_chart(const DiscriminationDesign& design);
/// Probability of the right material against exposure.
Chart exposure_chart(const DiscriminationDesign& design);

}  // namespace dmise
