#include "core/exchange/export_format.h"

#include "core/base/error.h"
#include "core/exchange/coco.h"
#include "core/exchange/csv.h"
#include "core/exchange/czml.h"
#include "core/exchange/oem.h"
#include "core/exchange/omm.h"
#include "core/exchange/regions.h"
#include "core/exchange/satnet.h"
#include "core/exchange/tdm.h"
#include "core/exchange/udl.h"

namespace dmise {
namespace {

template <std::string (*text)(const ExportRequest&)>
std::vector<ExportedFile> one_file(const ExportRequest& request) {
  return {{.path = "", .content = text(request), .copy_of = ""}};
}

}  // namespace

const std::vector<ExportFormat>& export_formats() {
  using enum ProductKind;
  static const std::vector<ExportFormat> formats{
      {.name = "tdm",
       .what = "CCSDS Tracking Data Message 2.0 (KVN): right ascension, declination, magnitude",
       .file = "KIND.tdm",
       .kinds = {detections, truth, tracks},
       .files = one_file<tdm_text>},
      {.name = "oem",
       .what = "CCSDS Orbit Ephemeris Message 2.0 (KVN): true states at mid exposure, or confirmed "
               "tracks with covariances",
       .file = "KIND.oem",
       .kinds = {truth, tracks},
       .files = one_file<run_oem_text>},
      {.name = "omm",
       .what = "CCSDS Orbit Mean-elements Messages 2.0 (XML): element sets of the catalogues, or "
               "fitted to confirmed tracks",
       .file = "KIND.omm.xml",
       .kinds = {truth, tracks},
       .takes_elements = true,
       .files = one_file<omm_text>},
      {.name = "satnet",
       .what = "directories of SatNet, with annotations as SatSim writes them",
       .file = "satnet",
       .kinds = {truth},
       .files = satnet_files},
      {.name = "coco",
       .what = "COCO annotations of truth, or COCO results of detections",
       .file = "coco-KIND.json",
       .kinds = {truth, detections},
       .files = one_file<coco_json>},
      {.name = "csv",
       .what = "tables of all fields",
       .file = "csv",
       .kinds = {detections, truth},
       .files = csv_files},
      {.name = "udl",
       .what = "EOObservation records of the Unified Data Library (JSON)",
       .file = "udl-KIND.json",
       .kinds = {detections, truth},
       .files = one_file<udl_json>},
      {.name = "czml",
       .what =
           "CZML for CesiumJS: objects or confirmed tracks, sensors and fields of view over time",
       .file = "KIND.czml",
       .kinds = {truth, tracks},
       .files = one_file<czml_text>},
      {.name = "regions",
       .what = "DS9 region files of each frame, in pixels and in ICRS: truth and detections",
       .file = "regions",
       .kinds = {detections, truth},
       .all_kinds = true,
       .files = region_files},
  };
  return formats;
}

const char* name_of(ProductKind kind) {
  constexpr const char* names[] = {"detections", "truth", "tracks"};
  return names[std::size_t(kind)];
}

void fail_empty(const RunProducts& run, const char* message, ProductKind kind) {
  throw ConfigError(run.directory + "/" + name_of(kind) +
                    ".jsonl: has nothing to export: " + message + " needs a segment");
}

}  // namespace dmise
