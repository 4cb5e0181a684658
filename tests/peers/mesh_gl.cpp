// SPDX-License-Identifier: Apache-2.0

#include "mesh_gl.h"

#include <utility>

#include "software_gl.h"

namespace peers {
namespace {

// The corners are texels of a texture, four for each: position and u, normal and v, tangent and w.
constexpr const char* kMeshVertexShader = R"(#version 330 core
uniform sampler2D corners;
uniform vec3 eye, right, up, toward, centre;
uniform float slope, aspect, scale, normalizes;
out vec3 position, tangent, normal, binormal;
out vec2 uv;
out float w;
vec4 corner(int k) {
    int at = gl_VertexID * 3 + k, width = textureSize(corners, 0).x;
    return texelFetch(corners, ivec2(at % width, at / width), 0);
}
void main() {
    vec4 a = corner(0), b = corner(1), c = corner(2);
    position = (a.xyz - centre) * scale;
    uv = vec2(a.w, b.w);
    normal = normalize(b.xyz);
    tangent = normalize(c.xyz);
    w = c.w;
    binormal = cross(normal, tangent) * w;
    if (normalizes > 0.5) binormal = normalize(binormal);
    vec3 p = position - eye;
    float depth = -dot(p, toward), near = 0.02, far = 20.0;
    gl_Position = vec4(dot(p, right) / (slope * aspect), dot(p, up) / slope,
                       (depth * (far + near) - 2.0 * far * near) / (far - near), depth);
})";

constexpr const char* kMeshFragmentShader = R"(#version 330 core
uniform sampler2D bumpMap;
uniform vec3 eye, light, lightColor, ambient, color, specColor;
uniform float shininess, normalizes, per_fragment;
in vec3 position, tangent, normal, binormal;
in vec2 uv;
in float w;
out vec4 fragment;
void main() {
    vec3 T = tangent, N = normal, B = binormal;
    if (per_fragment > 0.5) B = cross(N, T) * (w < 0.0 ? -1.0 : 1.0);
    if (normalizes > 0.5) { T = normalize(T); B = normalize(B); N = normalize(N); }
    vec3 n = normalize(texture(bumpMap, uv).xyz);
    n = normalize(n.x * T + n.y * B + n.z * N);
    vec3 view = normalize(eye - position), to_light = normalize(light);
    float facing = dot(n, to_light);
    vec3 specular = facing < 0.0 ? vec3(0.0) : specColor * pow(max(0.0, dot(reflect(-to_light, n), view)), shininess);
    fragment = vec4(ambient * color + lightColor * (color * max(0.0, facing) + specular), 1.0);
})";

GLuint upload_corners(const tex::TangentSpace& space) {
    constexpr std::size_t kWidth = 3072;
    const tex::MeshPart& part = space.part;
    const std::vector<tex::Float2>& uvs = part.uvs[static_cast<std::size_t>(space.uv_set)];
    std::vector<float> texels;
    for (std::size_t k = 0; k < part.indices.size(); ++k) {
        const std::uint32_t v = part.indices[k];
        const tex::Float3 &p = part.positions[v], &n = part.normals[v];
        const tex::Float4& t = space.tangents[k];
        const float up = part.v_axis == tex::YAxis::down ? 1.0f - uvs[v].y : uvs[v].y;
        for (const float value : {p.x, p.y, p.z, uvs[v].x, n.x, n.y, n.z, up, t.x, t.y, t.z, t.w < 0.0f ? -1.0f : 1.0f})
            texels.push_back(value);
    }
    const std::size_t rows = (texels.size() / 4 + kWidth - 1) / kWidth;
    texels.resize(rows * kWidth * 4);
    const Gl& gl = software_gl();
    GLuint texture = 0;
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, static_cast<GLsizei>(kWidth), static_cast<GLsizei>(rows), 0, GL_RGBA,
                  GL_FLOAT, texels.data());
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

void set_uniforms(const Gl& gl, const UniformLocation& place, const GlScene& s, const GlMesh& mesh) {
    const std::pair<const char*, float> numbers[] = {
        {"slope", s.slope},
        {"aspect", static_cast<float>(s.picture.width) / static_cast<float>(s.picture.height)},
        {"scale", mesh.scale},
        {"shininess", s.shininess},
        {"normalizes", mesh.binormal == Binormal::normalized ? 1.0f : 0.0f},
        {"per_fragment", mesh.binormal == Binormal::per_fragment ? 1.0f : 0.0f}};
    for (const auto& [name, value] : numbers) gl.Uniform1f(place(name), value);
    const std::pair<const char*, Vec3> vectors[] = {
        {"eye", s.eye},           {"right", s.right},      {"up", s.up},
        {"toward", s.toward},     {"centre", mesh.centre}, {"light", s.light},
        {"ambient", s.ambient},   {"color", s.diffuse},    {"lightColor", s.light_color},
        {"specColor", s.specular}};
    for (const auto& [name, v] : vectors) gl.Uniform3f(place(name), v[0], v[1], v[2]);
    gl.Uniform1i(place("bumpMap"), 0);
    gl.Uniform1i(place("corners"), 1);
}

}  // namespace

std::vector<float> draw_mesh(const GlScene& scene, const GlMesh& mesh) {
    if (!software_gl_works()) return {};
    const Gl& gl = software_gl();
    const GLuint program = make_program(kMeshVertexShader, kMeshFragmentShader);
    gl.ActiveTexture(GL_TEXTURE1);
    const GLuint corners = upload_corners(*mesh.space);
    gl.ActiveTexture(GL_TEXTURE0);
    const GLuint map = upload_map(*scene.map, [](float x, float y, float z) { return Rgba{x, y, z, 1.0f}; });
    const std::vector<float> rgba =
        draw_triangles(program, scene.picture, static_cast<int>(mesh.space->part.indices.size()),
                       [&](const UniformLocation& place) { set_uniforms(gl, place, scene, mesh); });
    for (const GLuint texture : {corners, map}) gl.DeleteTextures(1, &texture);
    gl.DeleteProgram(program);
    return flipped(rgba, scene.picture);
}

}  // namespace peers
