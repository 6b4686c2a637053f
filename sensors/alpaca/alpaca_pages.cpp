#include "core/base/files/json.h"
#include "core/base/version.h"
#include "sensors/alpaca/alpaca_connection.h"

namespace dmise {
namespace {

std::string html_of(const std::string& text) {
  std::string html;
  for (const char c : text) switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      default:
        html += c;
    }
  return html;
}

}  // namespace

std::string description_json(const AlpacaHub& hub) {
  JsonWriter json;
  json.begin_object().field("ServerName", "DMISE observatory").field("Manufacturer", "DMISE");
  json.field("ManufacturerVersion", software_name()).field("Location", hub.options.location);
  return json.end_object().take();
}

std::string configured_devices_json(const AlpacaHub& hub) {
  JsonWriter json;
  json.begin_array();
  for (const auto& device : hub.devices.configured()) {
    json.begin_object().field("DeviceName", device.name).field("DeviceType", device.type);
    json.field("DeviceNumber", std::uint64_t(device.number)).field("UniqueID", device.unique_id);
    json.end_object();
  }
  return json.end_array().take();
}

std::string setup_page(const AlpacaHub& hub) {
  std::string page =
      "<!doctype html><html lang='en'><meta charset='utf-8'><title>DMISE observatory</title>"
      "<h1>DMISE observatory</h1><p>" +
      html_of(hub.options.location) + ". It is " + hub.observatory.utc(hub.observatory.now()) +
      " UTC in the scenario.</p><table><tr><th>device<th>type<th>number</tr>";
  for (const auto& device : hub.devices.configured())
    page += "<tr><td>" + html_of(device.name) + "<td>" + device.type + "<td>" +
            std::to_string(device.number) + "</tr>";
  return page +
         "</table><p>The scenario and the options of <code>dmise observatory</code> set "
         "everything: "
         "there is nothing to set here.</p></html>";
}

}  // namespace dmise
