#pragma once

namespace dmise {

// The models of core/materials/brdf.h with what depends on the source alone taken out: a facet's
// radiance is diffuse g(out) + specular lobe / max(cos_out,
// least_cos_out) + emitted.

inline constexpr const char* vertex_shader = R"(#version 450 core
layout(location = 0) in vec4 clip;
layout(location = 1) in vec3 view_in;
layout(location = 2) in vec3 normal_in;
layout(location = 3) in vec4 diffuse_in;
layout(location = 4) in vec4 specular_in;
layout(location = 5) in vec4 emitted_in;
uniform vec4 piece;  // scale and offset of this piece within the tile
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
}
)";

inline constexpr const char* fragment_shader = R"(#version 450 core
in vec3 view;
flat in vec3 normal;
flat in vec4 diffuse;
flat in vec4 specular;
flat in vec4 emitted;
uniform vec4 source;  // unit direction to the light, camera axes
out vec4 radiance;
void main() {
  vec3 v = normalize(view);
  float c = max(dot(normal, v), 1e-6);
  float c2 = c * c;
  vec3 light = diffuse.rgb * (c2 / (c2 + diffuse.a * (1.0 - c2))) + emitted.rgb;
  vec3 h = v + source.xyz;
  if (emitted.a < 0.0) {
    float n = dot(normal, h);
    float cos2 = min(1.0, n * n / max(dot(h, h), 1e-30));
    vec3 s = cross(normal, h);
    float sin2 = min(1.0, dot(s, s) / max(dot(h, h), 1e-30));
    float root = specular.a * cos2 + sin2;
    light += specular.rgb / (root * root * max(c, 0.02));  // least_cos_out
  } else {
    float mirror = clamp(2.0 * dot(normal, source.xyz) * c - dot(v, source.xyz), 0.0, 1.0);
    if (mirror > 0.0) light += specular.rgb * exp2(emitted.a * log2(mirror));
  }
  radiance = vec4(light, 1.0);
}
)";

}  // namespace dmise
