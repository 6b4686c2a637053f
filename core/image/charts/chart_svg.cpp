#include <cmath>

#include "core/base/formatted.h"
#include "core/image/charts/chart_layout.h"

namespace dmise {
namespace {

std::string number(double value) {
  std::string s = formatted("%.1f", value);
  if (s.ends_with(".0")) s.resize(s.size() - 2);
  return s == "-0" ? "0" : s;
}

std::string hex(Colour c) { return formatted("#%02x%02x%02x", c.red, c.green, c.blue); }

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(c) >= 32)
      out += c;
  }
  return out;
}

class SvgPen : public ChartPen {
 public:
  SvgPen(int width_px, int height_px) {
    const std::string w = std::to_string(width_px), h = std::to_string(height_px);
    text_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h +
            "\" viewBox=\"0 0 " + w + " " + h +
            "\" font-family=\"Helvetica, Arial, sans-serif\">\n";
  }
  std::string finish() { return text_ + "</svg>\n"; }

  void rectangle(PagePoint corner, double width_px, double height_px, Colour fill) override {
    text_ += "<rect x=\"" + number(corner.x_px) + "\" y=\"" + number(corner.y_px) + "\" width=\"" +
             number(width_px) + "\" height=\"" + number(height_px) + "\" fill=\"" + hex(fill) +
             "\"/>\n";
  }

  void lines(const std::vector<std::vector<PagePoint>>& lines, const Stroke& stroke,
             PagePoint window, double width_px, double height_px) override {
    if (lines.empty()) return;
    const std::string id = "w" + std::to_string(++windows_);
    const bool whole = window.x_px == 0 && window.y_px == 0;
    if (!whole)
      text_ += "<clipPath id=\"" + id + "\"><rect x=\"" + number(window.x_px) + "\" y=\"" +
               number(window.y_px) + "\" width=\"" + number(width_px) + "\" height=\"" +
               number(height_px) + "\"/></clipPath>\n";
    text_ += "<g fill=\"none\" stroke=\"" + hex(stroke.colour) + "\" stroke-width=\"" +
             number(stroke.width_px) + "\" stroke-linejoin=\"round\"";
    if (stroke.opacity < 1.0) text_ += formatted(" stroke-opacity=\"%.2f\"", stroke.opacity);
    if (!whole) text_ += " clip-path=\"url(#" + id + ")\"";
    text_ += ">\n";
    // One path per line; otherwise the opacity of crossing lines would not add up.
    for (const auto& line : lines) {
      text_ += "<path d=\"";
      long x = 0, y = 0;  // in tenths of a pixel, to avoid accumulated rounding
      for (std::size_t k = 0; k < line.size(); ++k) {
        const long u = std::lround(10 * line[k].x_px), v = std::lround(10 * line[k].y_px);
        text_ += (k == 0   ? "M"
                  : k == 1 ? "l"
                           : " ") +
                 number(0.1 * double(u - x)) + " " + number(0.1 * double(v - y));
        x = u;
        y = v;
      }
      text_ += "\"/>\n";
    }
    text_ += "</g>\n";
  }

  void text(PagePoint at, const std::string& text, const TextStyle& style) override {
    const char* anchors[] = {"start", "middle", "end"};
    text_ += "<text x=\"" + number(at.x_px) + "\" y=\"" + number(at.y_px) + "\" font-size=\"" +
             number(style.size_px) + "\" fill=\"" + hex(style.colour) + "\" text-anchor=\"" +
             anchors[int(style.anchor)] + "\"";
    if (style.upwards)
      text_ += " transform=\"rotate(-90 " + number(at.x_px) + " " + number(at.y_px) + ")\"";
    text_ += ">" + escaped(text) + "</text>\n";
  }

  double text_width_px(const std::string& text, double size_px) const override {
    return 0.53 * size_px * double(text.size());  // average of a sans-serif face
  }

 private:
  std::string text_;
  int windows_ = 0;
};

}  // namespace

std::string drawn_svg(int width_px, int height_px, const std::function<void(ChartPen&)>& draw) {
  SvgPen pen(width_px, height_px);
  draw(pen);
  return pen.finish();
}

std::string chart_svg(const Chart& chart) {
  return drawn_svg(chart.width_px, chart.height_px, [&](ChartPen& pen) { draw_chart(chart, pen); });
}

}  // namespace dmise
