#include "core/report/run_report.h"

#include "core/base/files/digest.h"
#include "core/report/compact_bytes.h"
#include "core/report/page_resources.h"
#include "core/report/report_json.h"

namespace dmise {
namespace {

/// JSON within a script element: no "<" can end it.
std::string for_markup(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json)
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  return out;
}

std::string digest_source(std::string_view text) {
  const std::string hex = sha256_hex(text);
  std::string bytes;
  for (std::size_t k = 0; k < hex.size(); k += 2)
    bytes += char(std::stoi(hex.substr(k, 2), nullptr, 16));
  return "'sha256-" + base64(bytes) + "'";
}

}  // namespace

std::string run_report(const RunContents& run, const StarMap* stars, Threads& threads,
                       const ReportSettings& settings) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src 'self' "
      "file: data:; style-src " +
      digest_source(page_style) + "; script-src " + digest_source(page_script) +
      "; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>DMISE run</title>\n<style>";
  html += page_style;
  html +=
      "</style>\n</head>\n<body>\n<main id=\"page\"><h1>DMISE run</h1>"
      "<noscript>This page needs JavaScript; the files beside it do not.</noscript></main>\n"
      "<script type=\"application/json\" id=\"run\">";
  html += for_markup(report_json(run, stars, threads, settings));
  html += "</script>\n<script>";
  html += page_script;
  html += "</script>\n</body>\n</html>\n";
  return html;
}

}  // namespace dmise
