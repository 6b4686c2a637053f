#pragma once

namespace dmise {

// The models of core/materials/brdf.h with source-dependent factors precomputed: a facet's radiance
// is diffuse g(out) + specular lobe / max(cos_out, min_cos_out) + emitted.

// With `TEXTURED`, a material's pictures are applied: colours as a factor of the diffuse part,
// weighted by band, heights by tilting the normal against their gradient.
inline constexpr const char* vertex_shader = R"(
layout(location = 0) in vec4 clip;
layout(location = 1) in vec3 view_in;
layout(location = 2) in vec3 normal_in;
layout(location = 3) in vec4 diffuse_in;
layout(location = 4) in vec4 specular_in;
layout(location = 5) in vec4 emitted_in;
uniform vec4 piece;  // scale and offset of this piece within the tile
#ifdef TEXTURED
layout(location = 6) in vec4 place_in;
layout(location = 7) in vec3 slope_u_in;
layout(location = 8) in vec3 slope_v_in;
out vec4 place;
flat out vec3 slope_u;
flat out vec3 slope_v;
#endif
out vec3 view;
flat out vec3 normal;
flat out vec4 diffuse;
flat out vec4 specular;
flat out vec4 emitted;
void main() {
  gl_Position = vec4(clip.xy * piece.xy + piece.zw * clip.w, clip.zw);
  view = view_in;
  normal = normal_in;
  diffuse = diffuse_in;
  specular = specular_in;
  emitted = emitted_in;
#ifdef TEXTURED
  place = place_in;
  slope_u = slope_u_in;
  slope_v = slope_v_in;
#endif
}
)";

inline constexpr const char* fragment_shader = R"(
in vec3 view;
flat in vec3 normal;
flat in vec4 diffuse;
flat in vec4 specular;
flat in vec4 emitted;
uniform vec4 source;  // unit direction to the light, camera axes
#ifdef TEXTURED
in vec4 place;
flat in vec3 slope_u;
flat in vec3 slope_v;
layout(binding = 0) uniform sampler2D colours;
layout(binding = 1) uniform sampler2D slopes;
uniform mat3 weights;  // share of red, green and blue in each band
#else
#define facing normal
#define diffuse_rgb diffuse.rgb
#define specular_rgb specular.rgb
#endif
out vec4 radiance;
void main() {
#ifdef TEXTURED
  vec2 slope = texture(slopes, place.zw).rg;
  vec3 facing = normalize(normal - slope.x * slope_u - slope.y * slope_v);
  float lit = max(dot(facing, source.xyz), 0.0) / max(dot(normal, source.xyz), 1e-6);
  vec3 diffuse_rgb = diffuse.rgb * lit * (weights * texture(colours, place.xy).rgb);
  vec3 specular_rgb = specular.rgb * lit;
#endif
  vec3 v = normalize(view);
  float c = max(dot(facing, v), 1e-6);
  float c2 = c * c;
  vec3 light = diffuse_rgb * (c2 / (c2 + diffuse.a * (1.0 - c2))) + emitted.rgb;
  vec3 h = v + source.xyz;
  if (emitted.a < 0.0) {
    float n = dot(facing, h);
    float cos2 = min(1.0, n * n / max(dot(h, h), 1e-30));
    vec3 s = cross(facing, h);
    float sin2 = min(1.0, dot(s, s) / max(dot(h, h), 1e-30));
    float root = specular.a * cos2 + sin2;
    light += specular_rgb / (root * root * max(c, 0.02));  // least_cos_out
  } else {
    float mirror = clamp(2.0 * dot(facing, source.xyz) * c - dot(v, source.xyz), 0.0, 1.0);
    if (mirror > 0.0) light += specular_rgb * exp2(emitted.a * log2(mirror));
  }
  radiance = vec4(light, 1.0);
}
)";

}  // namespace dmise
