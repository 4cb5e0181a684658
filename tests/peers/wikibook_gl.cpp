// SPDX-License-Identifier: Apache-2.0

#include "wikibook_gl.h"

#include <utility>

#include "software_gl.h"

namespace peers {
namespace {

// "Lighting of Bumpy Surfaces" (fragWithAmbient) and "Projection of Bumpy Surfaces" of the wikibook, in GLSL 3.30; the
// model matrix is the identity. Only the places of the four corners, the camera as vectors instead of a matrix, and the
// sRGB curve at the end are ours.
constexpr const char* kVertexShader = R"(#version 330 core
uniform vec3 eye, right, up, toward, tangent;
uniform float slope, aspect, half_width, tangent_w;
out vec3 position, tangentWorld, normalWorld, binormalWorld, viewDirInScaledSurfaceCoords;
out vec2 texCoords;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    position = vec3((corner.x * 2.0 - 1.0) * half_width, corner.y * 2.0 - 1.0, 0.0);
    texCoords = tangent.x > 0.0 ? corner : vec2(-corner.x, corner.y);
    tangentWorld = tangent;
    normalWorld = vec3(0.0, 0.0, 1.0);
    binormalWorld = cross(normalWorld, tangentWorld) * tangent_w;
    vec3 viewDirInObjectCoords = eye - position;
    mat3 localSurface2ScaledObject = mat3(tangentWorld, binormalWorld, normalWorld);
    viewDirInScaledSurfaceCoords = viewDirInObjectCoords * localSurface2ScaledObject;
    vec3 p = position - eye;
    gl_Position = vec4(dot(p, right) / (slope * aspect), dot(p, up) / slope, 0.0, -dot(p, toward));
})";

constexpr const char* kFragmentShader = R"(#version 330 core
uniform sampler2D bumpMap, parallaxMap;
uniform vec3 eye, light, lightColor, ambient, color, specColor;
uniform float shininess, parallax, maxTexCoordOffset, pointLight;
in vec3 position, tangentWorld, normalWorld, binormalWorld, viewDirInScaledSurfaceCoords;
in vec2 texCoords;
out vec4 fragment;
float srgb(float c) { c = clamp(c, 0.0, 1.0); return c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1.0 / 2.4) - 0.055; }
void main() {
    float height = parallax * (-0.5 + texture(parallaxMap, texCoords).x);
    vec2 texCoordOffsets = clamp(height * viewDirInScaledSurfaceCoords.xy / viewDirInScaledSurfaceCoords.z,
                                 -maxTexCoordOffset, +maxTexCoordOffset);
    vec4 encodedNormal = texture(bumpMap, texCoords + texCoordOffsets);
    vec3 localCoords = vec3(2.0 * encodedNormal.a - 1.0, 2.0 * encodedNormal.g - 1.0, 0.0);
    localCoords.z = sqrt(1.0 - dot(localCoords, localCoords));
    mat3 local2WorldTranspose = mat3(tangentWorld, binormalWorld, normalWorld);
    vec3 normalDirection = normalize(local2WorldTranspose * localCoords);
    vec3 viewDirection = normalize(eye - position);
    vec3 lightDirection = normalize(light);
    float attenuation = 1.0;
    if (pointLight > 0.5) {
        vec3 vertexToLightSource = light - position;
        float distance = length(vertexToLightSource);
        attenuation = 1.0 / distance;
        lightDirection = normalize(vertexToLightSource);
    }
    vec3 ambientLighting = ambient * color;
    vec3 diffuseReflection = attenuation * lightColor * color * max(0.0, dot(normalDirection, lightDirection));
    vec3 specularReflection;
    if (dot(normalDirection, lightDirection) < 0.0) {
        specularReflection = vec3(0.0, 0.0, 0.0);
    } else {
        specularReflection = attenuation * lightColor * specColor *
            pow(max(0.0, dot(reflect(-lightDirection, normalDirection), viewDirection)), shininess);
    }
    vec3 sum = ambientLighting + diffuseReflection + specularReflection;
    fragment = vec4(srgb(sum.r), srgb(sum.g), srgb(sum.b), 1.0);
})";

void set_uniforms(const Gl& gl, const UniformLocation& place, const GlScene& s) {
    const std::pair<const char*, float> numbers[] = {
        {"slope", s.slope},
        {"aspect", static_cast<float>(s.picture.width) / static_cast<float>(s.picture.height)},
        {"half_width", s.half_width},
        {"tangent_w", s.tangent_w},
        {"shininess", s.shininess},
        {"parallax", s.height != nullptr ? s.parallax : 0.0f},
        {"maxTexCoordOffset", s.parallax_limit},
        {"pointLight", s.point_light ? 1.0f : 0.0f}};
    for (const auto& [name, value] : numbers) gl.Uniform1f(place(name), value);
    const std::pair<const char*, Vec3> vectors[] = {{"eye", s.eye},
                                                    {"right", s.right},
                                                    {"up", s.up},
                                                    {"toward", s.toward},
                                                    {"tangent", s.tangent},
                                                    {"light", s.light},
                                                    {"lightColor", s.light_color},
                                                    {"ambient", s.ambient},
                                                    {"color", s.diffuse},
                                                    {"specColor", s.specular}};
    for (const auto& [name, v] : vectors) gl.Uniform3f(place(name), v[0], v[1], v[2]);
    gl.Uniform1i(place("bumpMap"), 0);
    gl.Uniform1i(place("parallaxMap"), 1);
}

}  // namespace

std::vector<float> draw_wikibook_plane(const GlScene& scene) {
    if (!software_gl_works()) return {};
    const Gl& gl = software_gl();
    const GLuint program = make_program(kVertexShader, kFragmentShader);
    gl.ActiveTexture(GL_TEXTURE1);
    const GLuint height = scene.height != nullptr ? upload_plane(*scene.height) : 0;
    gl.ActiveTexture(GL_TEXTURE0);
    // What DXT5nm decodes to: x in alpha, y in green.
    const GLuint map = upload_map(*scene.map, [](float x, float y, float) {
        return Rgba{1.0f, (y + 1.0f) / 2.0f, 1.0f, (x + 1.0f) / 2.0f};
    });
    const std::vector<float> rgba =
        draw(program, scene.picture, 4, [&](const UniformLocation& place) { set_uniforms(gl, place, scene); });
    for (const GLuint texture : {height, map}) gl.DeleteTextures(1, &texture);
    gl.DeleteProgram(program);
    return flipped(rgba, scene.picture);
}

}  // namespace peers
