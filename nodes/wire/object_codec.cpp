#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <vector>

#include "dmise/v1/state.pb.h"
#include "nodes/wire/codecs.h"

static_assert(std::endian::native == std::endian::little, "arrays travel little endian");

namespace dmise {
namespace {

template <class T>
constexpr const char* type_name = sizeof(T) == 1   ? "uint8"
                                  : sizeof(T) == 4 ? "uint32"
                                                   : "float64";

template <class T, class M>
void append_array(M* message, std::string* bytes, const char* name,
                  std::initializer_list<std::size_t> shape, const std::vector<T>& values) {
  auto* layout = message->add_arrays();
  layout->set_name(name);
  layout->set_type(type_name<T>);
  for (const std::size_t extent : shape) layout->add_shape(extent);
  layout->set_offset_bytes(bytes->size());
  bytes->append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

template <class T, class M>
std::vector<T> take_array(const M& message, std::string_view bytes, const char* name,
                          std::initializer_list<std::size_t> shape) {
  for (const auto& layout : message.arrays()) {
    if (layout.name() != name) continue;
    if (layout.type() != type_name<T> ||
        !std::equal(layout.shape().begin(), layout.shape().end(), shape.begin(), shape.end()))
      throw Refused(Refusal::payload, std::string(name) + ": wrong type or shape");
    std::size_t size = sizeof(T);
    for (const std::size_t extent : shape) size *= extent;  // extents are bounded by the caller
    if (layout.offset_bytes() > bytes.size() || size > bytes.size() - layout.offset_bytes())
      throw Refused(Refusal::payload, std::string(name) + ": reaches beyond the array frame");
    std::vector<T> values(size / sizeof(T));
    if (size > 0) std::memcpy(values.data(), bytes.data() + layout.offset_bytes(), size);
    return values;
  }
  throw Refused(Refusal::payload, std::string(name) + ": no such array");
}

void encode_panel(const SunTrackingPanel& panel, v1::SunTrackingPanel* p) {
  p->set_hinge_x(panel.hinge.x);
  p->set_hinge_y(panel.hinge.y);
  p->set_hinge_z(panel.hinge.z);
  p->set_normal_x(panel.normal.x);
  p->set_normal_y(panel.normal.y);
  p->set_normal_z(panel.normal.z);
}

std::optional<SunTrackingPanel> decode_panel(const v1::SunTrackingPanel& p) {
  return SunTrackingPanel{.hinge = {p.hinge_x(), p.hinge_y(), p.hinge_z()},
                          .normal = {p.normal_x(), p.normal_y(), p.normal_z()}};
}

constexpr std::size_t rows_of_elements = std::size(element_rows);

/// Number of objects with elements: the second extent of their array, 0 without one.
std::size_t element_count(const v1::ObjectRoster& message) {
  if (message.arrays_size() == 0) return 0;
  const auto& layout = message.arrays(0);
  if (layout.shape_size() != 2 || layout.shape(1) > std::uint64_t(message.objects_size()))
    throw Refused(Refusal::payload, "elements: wrong type or shape");
  return layout.shape(1);
}

/// Number of objects with an attitude: the extent of their list of indices, 0 without one.
std::size_t attitude_count(const v1::ObjectStates& message) {
  for (const auto& layout : message.arrays()) {
    if (layout.name() != "attitude_object") continue;
    if (layout.shape_size() != 1 || layout.shape(0) > message.count())
      throw Refused(Refusal::payload, "attitude_object: wrong type or shape");
    return layout.shape(0);
  }
  return 0;
}

}  // namespace

Encoded encode_body(const ObjectRoster& roster) {
  v1::ObjectRoster message;
  for (const ObjectInfo& object : roster.objects) {
    auto* o = message.add_objects();
    o->set_catalogue_number(object.catalogue_number);
    o->set_name(object.name);
    o->set_designator(object.designator);
    o->set_radius_m(object.sphere.radius_m);
    o->set_albedo(object.sphere.albedo);
    o->set_element_age_s(object.element_age_s);
    if (object.panel) encode_panel(*object.panel, o->mutable_panel());
  }
  std::string arrays;
  if (const std::size_t k = roster.elements.size(); k > 0) {
    std::vector<double> values;
    values.reserve(rows_of_elements * k);
    for (const auto row : element_rows)
      for (const MeanElements& elements : roster.elements) values.push_back(elements.*row);
    append_array(&message, &arrays, "elements", {rows_of_elements, k}, values);
  }
  return {MessageKind::object_roster, message.SerializeAsString(), std::move(arrays)};
}

ObjectRoster decode_roster(std::string_view payload, std::string_view arrays) {
  const auto message = parse<v1::ObjectRoster>(payload);
  ObjectRoster roster;
  roster.objects.reserve(std::size_t(message.objects_size()));
  for (const auto& o : message.objects())
    roster.objects.push_back({.catalogue_number = o.catalogue_number(),
                              .name = o.name(),
                              .designator = o.designator(),
                              .sphere = {o.radius_m(), o.albedo()},
                              .element_age_s = o.element_age_s(),
                              .panel = o.has_panel() ? decode_panel(o.panel()) : std::nullopt});
  if (const std::size_t k = element_count(message); k > 0) {
    const auto values = take_array<double>(message, arrays, "elements", {rows_of_elements, k});
    roster.elements.resize(k);
    for (std::size_t row = 0; row < rows_of_elements; ++row)
      for (std::size_t i = 0; i < k; ++i)
        roster.elements[i].*element_rows[row] = values[row * k + i];
  }
  return roster;
}

Encoded encode_body(const ObjectStates& states) {
  v1::ObjectStates message;
  message.set_tick(states.tick);
  message.set_time_ns(states.time.ns);
  message.set_count(states.count);
  std::string arrays;
  arrays.reserve(states.count * (9 * sizeof(double) + 1));
  append_array(&message, &arrays, "position_m", {3, states.count}, states.position_m);
  append_array(&message, &arrays, "slope_m_per_s", {3, states.count}, states.slope_m_per_s);
  append_array(&message, &arrays, "velocity_m_per_s", {3, states.count}, states.velocity_m_per_s);
  append_array(&message, &arrays, "code", {states.count}, states.code);
  if (const std::size_t m = states.attitude_object.size(); m > 0) {
    append_array(&message, &arrays, "attitude_object", {m}, states.attitude_object);
    append_array(&message, &arrays, "gcrs_from_body", {4, m}, states.gcrs_from_body);
    append_array(&message, &arrays, "attitude_rate_rad_per_s", {3, m},
                 states.attitude_rate_rad_per_s);
  }
  if (!states.albedo.empty())
    append_array(&message, &arrays, "albedo", {states.count}, states.albedo);
  return {MessageKind::object_states, message.SerializeAsString(), std::move(arrays)};
}

ObjectStates decode_states(std::string_view payload, std::string_view arrays) {
  const auto message = parse<v1::ObjectStates>(payload);
  if (message.count() > max_array_bytes)
    throw Refused(Refusal::payload, "count: more objects than fit in an array frame");
  ObjectStates states;
  states.tick = message.tick();
  states.time = {message.time_ns()};
  states.count = message.count();
  states.position_m = take_array<double>(message, arrays, "position_m", {3, states.count});
  states.slope_m_per_s = take_array<double>(message, arrays, "slope_m_per_s", {3, states.count});
  states.velocity_m_per_s =
      take_array<double>(message, arrays, "velocity_m_per_s", {3, states.count});
  states.code = take_array<std::uint8_t>(message, arrays, "code", {states.count});
  if (const std::size_t m = attitude_count(message); m > 0) {
    states.attitude_object = take_array<std::uint32_t>(message, arrays, "attitude_object", {m});
    states.gcrs_from_body = take_array<double>(message, arrays, "gcrs_from_body", {4, m});
    states.attitude_rate_rad_per_s =
        take_array<double>(message, arrays, "attitude_rate_rad_per_s", {3, m});
  }
  if (std::ranges::any_of(message.arrays(), [](const auto& a) { return a.name() == "albedo"; }))
    states.albedo = take_array<double>(message, arrays, "albedo", {states.count});
  return states;
}

}  // namespace dmise
