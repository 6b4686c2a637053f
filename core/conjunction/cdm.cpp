#include "core/conjunction/cdm.h"

#include "core/base/formatted.h"
#include "core/base/printable_ascii.h"
#include "core/base/units.h"

namespace dmise {
namespace {

class Message {
 public:
  void text(const std::string& key, const std::string& value) {
    text_ += key + " = " + printable_ascii(value) + "\n";
  }
  void number(const std::string& key, double value, const char* unit, const char* form) {
    text_ +=
        key + " = " + formatted(form, value) + (*unit ? std::string(" [") + unit + "]" : "") + "\n";
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

std::string or_unknown(const std::string& text) { return text.empty() ? "UNKNOWN" : text; }

void write_state(Message& out, const OrbitState& s) {
  const double place[] = {s.position_m.x, s.position_m.y, s.position_m.z};
  const double rate[] = {s.velocity_m_per_s.x, s.velocity_m_per_s.y, s.velocity_m_per_s.z};
  const char* axes[] = {"X", "Y", "Z"};
  for (int i = 0; i < 3; ++i) out.number(axes[i], place[i] / km, "km", "%.9f");
  for (int i = 0; i < 3; ++i)
    out.number(std::string(axes[i]) + "_DOT", rate[i] / km, "km/s", "%.12f");
}

void write_covariance(Message& out, const OrbitEstimate& estimate) {
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() =
      orbit_axes(estimate.state).transpose();
  const Eigen::Matrix<double, 6, 6> rtn =
      turn * estimate.covariance.topLeftCorner<6, 6>() * turn.transpose();
  const char* rows[] = {"R", "T", "N", "RDOT", "TDOT", "NDOT"};
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column)
      out.number(std::string("C") + rows[row] + "_" + rows[column], rtn(row, column),
                 row < 3      ? "m**2"
                 : column < 3 ? "m**2/s"
                              : "m**2/s**2",
                 "%.9e");
}

void write_object(Message& out, const char* which, const CdmObject& object, const CdmFacts& facts,
                  const OrbitEstimate& estimate) {
  out.text("OBJECT", which);
  out.text("OBJECT_DESIGNATOR", object.number);
  out.text("CATALOG_NAME", "SATCAT");
  out.text("OBJECT_NAME", or_unknown(object.name));
  out.text("INTERNATIONAL_DESIGNATOR", or_unknown(object.designator));
  out.text("EPHEMERIS_NAME", "NONE");
  out.text("COVARIANCE_METHOD", facts.covariance_method);
  out.text("MANEUVERABLE", "N/A");
  out.text("REF_FRAME", "GCRF");
  write_state(out, estimate.state);
  write_covariance(out, estimate);
}

}  // namespace

std::string cdm_text(const Encounter& encounter, const CdmFacts& facts) {
  Message out;
  out.text("CCSDS_CDM_VERS", "1.0");
  out.text("CREATION_DATE", facts.created_utc);
  out.text("ORIGINATOR", "DMISE");
  out.text("MESSAGE_ID", facts.message_id);
  out.text("TCA", facts.closest_utc);
  const RelativeMotion motion = relative_motion(encounter);
  out.number("MISS_DISTANCE", norm(motion.position_m), "m", "%.3f");
  out.number("RELATIVE_SPEED", norm(motion.velocity_m_per_s), "m/s", "%.4f");
  const double r[] = {motion.position_m.x, motion.position_m.y, motion.position_m.z};
  const double v[] = {motion.velocity_m_per_s.x, motion.velocity_m_per_s.y,
                      motion.velocity_m_per_s.z};
  const char* axes[] = {"R", "T", "N"};
  for (int i = 0; i < 3; ++i)
    out.number(std::string("RELATIVE_POSITION_") + axes[i], r[i], "m", "%.3f");
  for (int i = 0; i < 3; ++i)
    out.number(std::string("RELATIVE_VELOCITY_") + axes[i], v[i], "m/s", "%.4f");
  out.number("COLLISION_PROBABILITY", facts.probability, "", "%.6e");
  out.text("COLLISION_PROBABILITY_METHOD", "FOSTER-1992");
  write_object(out, "OBJECT1", facts.first, facts, encounter.first);
  write_object(out, "OBJECT2", facts.second, facts, encounter.second);
  return out.take();
}

}  // namespace dmise
