#pragma once

namespace dmise {

// Points are squares of cells of the Gaussian's extent. OpenGL's own points vanish with their
// centre, and their size is limited.

inline constexpr const char* point_vertex_shader =
    R"(layout(location = 0) in vec2 cell_in;  // floor of the position, from the piece's first cell
layout(location = 1) in vec2 phase_in;  // fraction of the position, [0, 1)
layout(location = 2) in float light_in;
uniform vec4 piece;                     // 2 / columns, 2 / rows, reach in cells
flat out vec2 cell;
flat out vec2 phase;
flat out float light;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  vec2 place = cell_in + 1.0 - piece.z + 2.0 * piece.z * corner;
  gl_Position = vec4(place * piece.xy - 1.0, 0.0, 1.0);
  cell = cell_in;
  phase = phase_in;
  light = light_in;
}
)";

inline constexpr const char* point_fragment_shader = R"(flat in vec2 cell;
flat in vec2 phase;
flat in float light;
uniform vec4 spread;  // 1 / sigma, 1 / (sqrt 2 sigma), 1 / (sqrt(2 pi) sigma), 1: wide
out float added;

// erfc for x >= 0 to 1.5e-7; Abramowitz & Stegun 1964, 7.1.26.
vec2 upper(vec2 x) {
  vec2 t = 1.0 / (1.0 + 0.3275911 * x);
  vec2 series =
      t * (0.254829592 +
           t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
  return series * exp(-x * x);
}

// Light of the unit Gaussian between d - 1/2 and d + 1/2, d >= 0.
vec2 narrow_share(vec2 d) {
  vec2 inner = (d - 0.5) * spread.y;
  vec2 near = upper(abs(inner));
  vec2 before = mix(near, 2.0 - near, lessThan(inner, vec2(0.0)));
  return 0.5 * (before - upper((d + 0.5) * spread.y));
}

// Three Gauss-Legendre nodes: for sigma >= 2 right to 1e-7 of the share.
vec2 wide_share(vec2 d) {
  vec2 a = (d - 0.3872983346207417) * spread.x, b = d * spread.x;
  vec2 c = (d + 0.3872983346207417) * spread.x;
  return spread.z * (exp(-0.5 * a * a) * (5.0 / 18.0) + exp(-0.5 * b * b) * (8.0 / 18.0) +
                     exp(-0.5 * c * c) * (5.0 / 18.0));
}

void main() {
  vec2 d = abs(gl_FragCoord.xy - 0.5 - cell - phase);
  vec2 share = spread.w > 0.5 ? wide_share(d) : narrow_share(d);
  added = light * share.x * share.y;
}
)";

inline constexpr const char* patch_vertex_shader =
    R"(layout(location = 0) in vec4 box_in;  // first and last + 1, from the piece's first cell
layout(location = 1) in vec4 map_in;  // u0, du, v0, dv
layout(location = 2) in vec4 c0_in;   // coefficients of v^0
layout(location = 3) in vec4 c1_in;
layout(location = 4) in vec4 c2_in;
layout(location = 5) in vec4 c3_in;
uniform vec4 piece;  // 2 / columns, 2 / rows
flat out vec2 first;
flat out vec4 map;
flat out vec4 c0;
flat out vec4 c1;
flat out vec4 c2;
flat out vec4 c3;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(mix(box_in.xy, box_in.zw, corner) * piece.xy - 1.0, 0.0, 1.0);
  first = box_in.xy;
  map = map_in;
  c0 = c0_in;
  c1 = c1_in;
  c2 = c2_in;
  c3 = c3_in;
}
)";

inline constexpr const char* patch_fragment_shader = R"(flat in vec2 first;
flat in vec4 map;
flat in vec4 c0;
flat in vec4 c1;
flat in vec4 c2;
flat in vec4 c3;
out float value;
void main() {
  vec2 uv = map.xz + map.yw * (gl_FragCoord.xy - 0.5 - first);
  vec4 c = c0 + uv.y * (c1 + uv.y * (c2 + uv.y * c3));
  value = c.x + uv.x * (c.y + uv.x * (c.z + uv.x * c.w));
}
)";

}  // namespace dmise
