// SPDX-License-Identifier: Apache-2.0
// Draws meshes on the reader's GPU as preview-normals --mesh does: the same camera, decoders, filter and light
// (tex/preview.h, tex/mesh.h). Where a pixel shows several triangles, the picture is smoothed with fewer
// samples than there.

const kMeshVertexShader = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 texel;
uniform mat4 camera;
uniform vec4 place;
uniform int kind;
out vec3 point, normalAcross, tangentAcross, binormalAcross;
out vec2 uv;
out float sign;

vec3 unitOrNull(vec3 v) { return dot(v, v) > 1e-12 ? normalize(v) : vec3(0.0); }
void main() {
  point = position * place.w + place.xyz;
  uv = texel;
  sign = tangent.w < 0.0 ? -1.0 : 1.0;
  normalAcross = unitOrNull(normal);
  tangentAcross = unitOrNull(tangent.xyz);
  binormalAcross = sign * cross(normalAcross, tangentAcross);
  if (kind == 2) binormalAcross = unitOrNull(binormalAcross);
  gl_Position = camera * vec4(point, 1.0);
}`;

// The numbers of `kind` are those of kDecoderKinds.
const kMeshShader = kShading + `
uniform highp int kind;
uniform bool rebuildsZ;
uniform sampler2D textureA, missed;
uniform bool showsMissed;
uniform Map a;
uniform float bump;
in vec3 point, normalAcross, tangentAcross, binormalAcross;
in vec2 uv;
in float sign;
out vec4 color;

// Trilinear samples along the longer axis of the pixel's footprint, as sample() of preview-normals takes them.
vec4 filtered(vec2 dx, vec2 dy) {
  vec2 size = vec2(textureSize(textureA, 0));
  float px = length(dx * size), py = length(dy * size), longer = max(px, py), shorter = min(px, py);
  if (!(longer > 1.0)) return textureLod(textureA, uv, 0.0);
  float count = shorter > 0.0 ? min(ceil(max(longer / shorter - 1e-6, 1.0)), 8.0) : 8.0;
  float level = log2(longer / count);
  vec2 axis = px >= py ? dx : dy;
  vec4 sum = vec4(0.0);
  for (float k = 0.5; k < count; k += 1.0) sum += textureLod(textureA, uv + axis * (k / count - 0.5), level);
  return sum / count;
}
vec3 unitOrSame(vec3 v) { return dot(v, v) > 1e-12 ? normalize(v) : v; }
void main() {
  // uv / w and 1 / w are linear over the picture, which gives the exact step to the next pixel.
  float q = gl_FragCoord.w;
  vec2 p = uv * q;
  vec2 dx = (dFdx(p) - uv * dFdx(q)) / (q + dFdx(q)), dy = (dFdy(p) - uv * dFdy(q)) / (q + dFdy(q));
  vec3 stored = read(a, filtered(dx, dy));
  vec3 n = scaled(rebuildsZ ? withZ(stored.xy) : normalOf(a, stored), bump);
  vec3 t = tangentAcross, across = normalAcross;
  vec3 b = kind == 1 ? (sign < 0.0 ? -1.0 : 1.0) * cross(across, t) : binormalAcross;
  if (kind == 2) { t = unitOrSame(t); b = unitOrSame(b); across = unitOrSame(across); }
  vec3 lit = linearLight(unitOf(n.x * t + n.y * b + n.z * across), point, ${kAmbient.toFixed(2)});
  bool isMissed = showsMissed && texture(missed, uv).r > 0.5;
  color = vec4(isMissed ? vec3(0.6, 0.02, 0.02) * (0.3 + dot(lit, vec3(0.4))) : lit, 1.0);
}`;

// Makes sRGB of a finished picture, whose samples were averaged as light.
const kDisplayShader = kShading + `
uniform sampler2D picture;
out vec4 color;
void main() { color = vec4(displayed(texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb), 1.0); }`;

const kDecoderKinds = ["per-vertex", "per-fragment", "normalized"];
const kVertexSize = 28;  // bytes; see html_mesh.h
const kGround = [38, 40, 44].map((code) => ((code / 255 + 0.055) / 1.055) ** 2.4);

const dot = (p, q) => p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
const sumOf = (vectors, factors) => [0, 1, 2].map((c) => vectors.reduce((sum, v, k) => sum + factors[k] * v[c], 0));

// The camera of preview-normals for a square picture of a mesh: its axes, half the height of the picture plane through
// the origin, the eye, and the matrix that WebGL needs.
// `reach`: of what is drawn, from the origin.
function viewOf(yaw, pitch, reach = 1) {
  const [sy, cy, sp, cp] = [yaw, pitch].flatMap((angle) => [Math.sin(angle * Math.PI / 180), Math.cos(angle * Math.PI / 180)]);
  const right = [cy, 0, -sy], up = [-sy * sp, cp, -cy * sp], toward = [sy * cp, sp, cy * cp];
  const slope = Math.tan(Math.PI / 12), half = 1.06 * Math.hypot(1, slope), distance = half / slope;
  const near = Math.max(distance - 1.01 * reach, 0.1), far = distance + 1.01 * reach;
  const depth = (far + near) / (far - near), shift = 2 * far * near / (far - near);
  const rows = [[...right.map((c) => c / slope), 0], [...up.map((c) => c / slope), 0],
    [...toward.map((c) => -c * depth), depth * distance - shift], [...toward.map((c) => -c), distance]];
  return {right, up, toward, half, eye: toward.map((c) => c * distance), matrix: [0, 1, 2, 3].flatMap((column) => rows.map((row) => row[column]))};
}

// Draws meshes by number, with the maps of a Lighting.
class MeshLighting {
  constructor(lighting, meshes) {
    Object.assign(this, {lighting, meshes, loaded: new Map(), masks: new Map(), size: 0});
    const gl = this.gl = lighting.gl;
    this.program = new Program(gl, kMeshVertexShader, kMeshShader);
    this.display = new Program(gl, kPictureShader, kDisplayShader);
    this.samples = Math.min(8, gl.getParameter(gl.MAX_SAMPLES));
  }

  // The vertex array of mesh `number`.
  mesh(number) {
    if (this.loaded.has(number)) return this.loaded.get(number);
    const gl = this.gl, {vertices} = this.meshes[number], bytes = bytesOf("mesh-" + number), end = vertices * kVertexSize;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, bytes.subarray(0, end), gl.STATIC_DRAW);
    [[3, gl.SHORT, 0], [3, gl.SHORT, 6], [4, gl.SHORT, 12], [2, gl.FLOAT, 20]].forEach(([count, type, at], place) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, count, type, true, kVertexSize, at);
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, bytes.subarray(end), gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    this.loaded.set(number, array);
    return array;
  }

  // A promise of the texture of a mask: the PNG in #id.
  mask(id) {
    if (!this.masks.has(id)) this.masks.set(id, this.loadMask(id));
    return this.masks.get(id);
  }

  async loadMask(id) {
    const gl = this.gl, picture = await createImageBitmap(new Blob([bytesOf(id)], {type: "image/png"}));
    const texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return texture;
  }

  // Prepares framebuffers: this.many has several samples for each pixel, this.one has their averages.
  prepare(size) {
    if (this.size === size) return;
    const gl = this.gl;
    const buffer = (attachment, format) => {
      const id = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, id);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, this.samples, format, size, size);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, id);
    };
    this.many = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.many);
    buffer(gl.COLOR_ATTACHMENT0, gl.SRGB8_ALPHA8);
    buffer(gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24);
    this.one = gl.createFramebuffer();
    this.picture = gl.createTexture();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.one);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.picture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.SRGB8_ALPHA8, size, size);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.picture, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this.size = size;
  }

  // Draws `scene` and copies it to the square `canvas`: {map, mesh, y, kind (a word of kDecoderKinds), rebuildsZ, view,
  // bump, light: [x, y, z] in the world, point, missed (the id of a mask, or null)}. Returns what the GPU was given.
  async draw(canvas, scene) {
    const gl = this.gl, texture = await this.lighting.texture(scene.map);
    const mask = scene.missed ? await this.mask(scene.missed) : null;
    this.lighting.begin(canvas, this.program);
    const array = this.mesh(scene.mesh);
    this.prepare(canvas.width);
    this.drawMesh(array, texture, mask, scene);
    const all = [0, 0, this.size, this.size];
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.many);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, this.one);
    gl.blitFramebuffer(...all, ...all, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.useProgram(this.display.id);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.picture);
    gl.uniform1i(this.display.uniform("picture"), 0);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    this.lighting.end(canvas);
    return texture;
  }

  drawMesh(array, texture, mask, {map, mesh, y, kind, rebuildsZ, view, bump, light, point}) {
    const gl = this.gl, program = this.program, {vertices, triangles} = this.meshes[mesh];
    this.lighting.setMap(program, "a", 0, map, texture, y);
    this.lighting.setLight(program, light, point, view.eye);
    gl.uniformMatrix4fv(program.uniform("camera"), false, view.matrix);
    gl.uniform4fv(program.uniform("place"), this.meshes[mesh].place || [0, 0, 0, 1]);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, mask || texture.id);
    gl.uniform1i(program.uniform("missed"), 1);
    gl.uniform1i(program.uniform("showsMissed"), mask ? 1 : 0);
    gl.uniform1i(program.uniform("kind"), kDecoderKinds.indexOf(kind));
    gl.uniform1i(program.uniform("rebuildsZ"), rebuildsZ ? 1 : 0);
    gl.uniform1f(program.uniform("bump"), bump);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.many);
    gl.clearColor(...kGround, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
    gl.bindVertexArray(array);
    gl.drawElements(gl.TRIANGLES, 3 * triangles, vertices <= 65535 ? gl.UNSIGNED_SHORT : gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.DEPTH_TEST);
  }
}
