#include "sensors/indi/indi_vector.h"

#include <sodium.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

constexpr const char* state_names[] = {"Idle", "Ok", "Busy", "Alert"};

std::string escaped(const std::string& text) {
  std::string xml;
  for (const char c : printable(text, 1000)) switch (c) {
      case '&':
        xml += "&amp;";
        break;
      case '<':
        xml += "&lt;";
        break;
      case '>':
        xml += "&gt;";
        break;
      case '"':
        xml += "&quot;";
        break;
      default:
        xml += c;
    }
  return xml;
}

std::string attribute(const char* key, const std::string& value) {
  return std::string(" ") + key + "=\"" + escaped(value) + "\"";
}

std::string end_of_tag(const IndiRemark& remark) {
  return attribute("timestamp", remark.utc) +
         (remark.message.empty() ? "" : attribute("message", remark.message)) + ">\n";
}

std::string value_text(const IndiItem& item) {
  if (const auto* number = std::get_if<double>(&item.value)) {
    if (!std::isfinite(*number)) throw Error(std::string(item.name) + ": is not finite");
    return shortest_text(*number);
  }
  if (const auto* on = std::get_if<bool>(&item.value)) return *on ? "On" : "Off";
  return escaped(std::get<std::string>(item.value));
}

/// Seconds within which something that is asked for happens at worst.
std::string timeout() { return attribute("timeout", "60"); }

std::string range_attributes(const IndiRange& range) {
  return attribute("format", range.format) + attribute("min", shortest_text(range.low)) +
         attribute("max", shortest_text(range.high)) + attribute("step", shortest_text(range.step));
}

std::string permission(const IndiVector& v) {
  if (v.title.kind == IndiKind::light) return {};
  std::string text = attribute("perm", v.can_be_set ? "rw" : "ro") + timeout();
  if (v.title.kind == IndiKind::toggle)
    text += attribute("rule", v.title.rule == IndiRule::one_of_many ? "OneOfMany" : "AtMostOne");
  return text;
}

std::string begin_update(const IndiVector& v, const IndiRemark& remark) {
  return "<set" + std::string(name_of(v.title.kind)) + "Vector" + attribute("device", v.device) +
         attribute("name", v.title.name) + attribute("state", state_names[int(v.state)]) +
         timeout() + end_of_tag(remark);
}

std::string end_update(const IndiVector& v) {
  return "</set" + std::string(name_of(v.title.kind)) + "Vector>\n";
}

bool is_noticed(const IndiItem& before, const IndiItem& after) {
  const auto* number = std::get_if<double>(&after.value);
  const auto* old = std::get_if<double>(&before.value);
  if (number && old) return std::abs(*number - *old) > after.range.noticed;
  return before.value != after.value;
}

}  // namespace

std::string indi_definition(const IndiVector& v, const IndiRemark& remark) {
  const std::string kind(name_of(v.title.kind));
  std::string xml =
      "<def" + kind + "Vector" + attribute("device", v.device) + attribute("name", v.title.name) +
      attribute("label", v.title.label) + attribute("group", v.title.group) +
      attribute("state", state_names[int(v.state)]) + permission(v) + end_of_tag(remark);
  for (const IndiItem& item : v.items) {
    xml += "<def" + kind + attribute("name", item.name) + attribute("label", item.label);
    if (v.title.kind == IndiKind::number) xml += range_attributes(item.range);
    xml +=
        v.title.kind == IndiKind::blob ? "/>\n" : ">" + value_text(item) + "</def" + kind + ">\n";
  }
  return xml + "</def" + kind + "Vector>\n";
}

std::string indi_update(const IndiVector& v, const IndiRemark& remark) {
  const std::string kind(name_of(v.title.kind));
  std::string xml = begin_update(v, remark);
  for (const IndiItem& item : v.items)
    xml += "<one" + kind + attribute("name", item.name) + ">" + value_text(item) + "</one" + kind +
           ">\n";
  return xml + end_update(v);
}

// Without the attribute `enclen` of INDI's library, whose clients then expect ends of lines in the
// text, and take these for bytes of the BLOB.
std::string indi_blob_update(const IndiVector& v, const std::string& bytes, const char* format,
                             const IndiRemark& remark) {
  return begin_update(v, remark) + "<oneBLOB" + attribute("name", v.items.front().name) +
         attribute("size", std::to_string(bytes.size())) + attribute("format", format) + ">" +
         base64(bytes) + "</oneBLOB>\n" + end_update(v);
}

std::string indi_deletion(const std::string& device, const char* property,
                          const IndiRemark& remark) {
  return "<delProperty" + attribute("device", device) + attribute("name", property) +
         end_of_tag(remark) + "</delProperty>\n";
}

std::string indi_message(const std::string& device, const IndiRemark& remark) {
  return "<message" + (device.empty() ? "" : attribute("device", device)) + end_of_tag(remark) +
         "</message>\n";
}

bool is_noticed(const IndiVector& before, const IndiVector& after) {
  if (before.state != after.state || before.items.size() != after.items.size()) return true;
  for (std::size_t i = 0; i < after.items.size(); ++i)
    if (is_noticed(before.items[i], after.items[i])) return true;
  return false;
}

std::string base64(const std::string& bytes) {
  std::string text(sodium_base64_ENCODED_LEN(bytes.size(), sodium_base64_VARIANT_ORIGINAL), '\0');
  sodium_bin2base64(text.data(), text.size(), reinterpret_cast<const unsigned char*>(bytes.data()),
                    bytes.size(), sodium_base64_VARIANT_ORIGINAL);
  text.pop_back();  // the end of a C string
  return text;
}

}  // namespace dmise
