// SPDX-License-Identifier: Apache-2.0
// Lights a normal map on the reader's GPU: the plane that preview-normals draws, with the same formulas
// (tex/preview.h). One WebGL context draws for every canvas of the page, also meshes (report_mesh.js).

// What the shaders of the plane and of meshes share.
const kShading = `#version 300 es
precision highp float;
struct Map { vec4 x, y, z; float scale, offset, sign; bool hasZ; };
uniform vec3 eye, light;
uniform bool isPoint;

vec3 read(Map map, vec4 texel) {
  vec4 t = texel * map.scale + map.offset;
  return vec3(dot(t, map.x), map.sign * dot(t, map.y), dot(t, map.z));
}
vec3 unitOf(vec3 v) { return dot(v, v) > 1e-12 ? normalize(v) : vec3(0.0, 0.0, 1.0); }
vec3 withZ(vec2 v) {
  float square = dot(v, v);
  return square <= 1.0 ? vec3(v, sqrt(1.0 - square)) : vec3(v * inversesqrt(square), 0.0);
}
vec3 normalOf(Map map, vec3 stored) { return map.hasZ ? unitOf(vec3(stored.xy, max(stored.z, 0.0))) : withZ(stored.xy); }
vec3 scaled(vec3 n, float bump) { return unitOf(vec3(n.xy * bump, n.z)); }
vec3 displayed(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(1.055 * pow(max(c, 1e-9), vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}
vec3 linearLight(vec3 n, vec3 point, float ambient) {
  const float albedo = 0.6, specular = 0.25, shininess = 20.0;
  vec3 view = normalize(eye - point);
  vec3 way = isPoint ? light - point : light;
  float weakens = isPoint ? 1.0 / max(length(way), 1e-6) : 1.0;
  way = normalize(way);
  float facing = dot(n, way), cosine = dot(2.0 * facing * n - way, view);
  float shine = facing >= 0.0 && cosine > 0.0 ? pow(cosine, shininess) : 0.0;
  return vec3(ambient * albedo + weakens * (albedo * max(0.0, facing) + specular * shine));
}
`;

const kAmbient = 0.03, kMuchAmbient = 0.6;  // the second one to show occlusion by

// A triangle that covers the whole picture.
const kPictureShader = `#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`;

const kPlaneEye = [0, 0, 3.7320508075688776];

const kPlaneShader = kShading + `
uniform sampler2D textureA, textureB, occlusionA, occlusionB;
uniform Map a, b;
uniform vec2 size, tiles;   // of the canvas in pixels; how often the map stands on the plane
uniform float aspect, edge, bump;   // edge: where B begins, in pixels
uniform int show;
out vec4 color;

vec3 viridis(float t) {
  t = clamp(t, 0.0, 1.0);
  return clamp(vec3(0.27772733, 0.00540734, 0.33409981) + t * (vec3(0.10509304, 1.40461353, 1.38459016) + t * (vec3(-0.33086183, 0.21484756, 0.09509516)
    + t * (vec3(-4.63423050, -5.79910097, -19.33244096) + t * (vec3(6.22826994, 14.17993337, 56.69055260)
    + t * (vec3(4.77638500, -13.74514538, -65.35303263) + t * vec3(-5.43545586, 4.64585261, 26.31243525)))))), 0.0, 1.0);
}
vec3 diverging(float t) {
  float place = (clamp(t, -1.0, 1.0) + 1.0) * 2.0;
  vec3 c = mix(vec3(0.06, 0.20, 0.42), vec3(0.36, 0.61, 0.83), min(place, 1.0));
  c = mix(c, vec3(0.97, 0.97, 0.96), clamp(place - 1.0, 0.0, 1.0));
  c = mix(c, vec3(0.94, 0.64, 0.34), clamp(place - 2.0, 0.0, 1.0));
  return mix(c, vec3(0.48, 0.19, 0.02), clamp(place - 3.0, 0.0, 1.0));
}
vec3 shown(Map map, vec4 texel, float open, vec3 point) {
  vec3 stored = read(map, texel);
  vec3 n = normalOf(map, stored);
  if (show == 4) return diverging((map.hasZ ? length(stored) - 1.0 : 0.0) / 0.1);
  if (show == 5) return diverging((map.hasZ ? stored.z - sqrt(1.0 - min(dot(stored.xy, stored.xy), 1.0)) : 0.0) / 0.1);
  n = scaled(n, bump);
  if (show == 1) return (n + 1.0) / 2.0;
  if (show == 2) return viridis(length(n.xy) / max(n.z, 1.0 / 256.0) / 2.0);
  if (show == 3) return viridis(degrees(atan(length(n.xy), n.z)) / 90.0);
  return displayed(linearLight(n, point, show == 6 ? ${kMuchAmbient.toFixed(2)} * open : ${kAmbient.toFixed(2)}));
}
void main() {
  vec2 place = gl_FragCoord.xy / size;
  vec2 uv = vec2(place.x, 1.0 - place.y) * tiles;
  vec3 point = vec3((2.0 * place - 1.0) * vec2(aspect, 1.0), 0.0);
  vec4 texelA = texture(textureA, uv), texelB = texture(textureB, uv);
  float openA = texture(occlusionA, uv).r, openB = texture(occlusionB, uv).r;
  color = vec4(gl_FragCoord.x < edge ? shown(a, texelA, openA, point) : shown(b, texelB, openB, point), 1.0);
}`;

// The bytes of an element: #map-n, #mesh-n.
function bytesOf(id) {
  const text = atob(document.getElementById(id).textContent), bytes = new Uint8Array(text.length);
  for (let k = 0; k < bytes.length; ++k) bytes[k] = text.charCodeAt(k);
  return bytes;
}

// The bytes of #map-n, split into levels.
function levelsOf(maps, number) {
  const bytes = bytesOf("map-" + number);
  let at = 0;
  return maps[number].levels.map(([width, height, size]) => ({width, height, bytes: bytes.subarray(at, at += size)}));
}

// A pair of shaders on the GPU.
class Program {
  constructor(gl, vertexShader, fragmentShader) {
    Object.assign(this, {gl, id: gl.createProgram(), places: {}});
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragmentShader]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(this.id, shader);
    }
    gl.linkProgram(this.id);
    if (!gl.getProgramParameter(this.id, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(this.id) || "the shader was refused");
  }

  // The place of a uniform variable.
  uniform(name) {
    if (!(name in this.places)) this.places[name] = this.gl.getUniformLocation(this.id, name);
    return this.places[name];
  }
}

// Draws maps by number. Throws if there is no WebGL 2.
class Lighting {
  static kMostTextures = 24;  // on the GPU; more than the live stages and their B maps need

  constructor(maps) {
    this.maps = maps;
    this.canvas = document.createElement("canvas");
    const gl = this.gl = this.canvas.getContext("webgl2", {alpha: false, antialias: false, depth: false});
    if (!gl) throw new Error("no WebGL 2");
    this.s3tc = gl.getExtension("WEBGL_compressed_texture_s3tc");
    this.rgtc = gl.getExtension("EXT_texture_compression_rgtc");
    this.textures = new Map();
    this.occlusions = new Map();
    this.plane = new Program(gl, kPictureShader, kPlaneShader);
  }

  // WebGL's name for a format, if this GPU supports it and WebGL accepts the extent of every level.
  packedFormat(map) {
    if (!map.packed || map.levels.some(([w, h], k) => [w, h].some((n) => n % 4 !== 0 && (k === 0 || n > 2)))) return 0;
    const {s3tc, rgtc} = this;
    return {
      "bc1-unorm": s3tc && s3tc.COMPRESSED_RGB_S3TC_DXT1_EXT, "bc2-unorm": s3tc && s3tc.COMPRESSED_RGBA_S3TC_DXT3_EXT,
      "bc3-unorm": s3tc && s3tc.COMPRESSED_RGBA_S3TC_DXT5_EXT, "bc5-unorm": rgtc && rgtc.COMPRESSED_RED_GREEN_RGTC2_EXT,
      "bc5-snorm": rgtc && rgtc.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT,
    }[map.format] || 0;
  }

  // A promise of the textures of map `number` on the GPU. It is kept for the next call.
  texture(number) {
    const kept = this.textures.get(number);
    this.textures.delete(number);
    const made = kept || this.load(number);
    this.textures.set(number, made);  // the most recently used entry is the last in the map
    for (const [old, texture] of this.textures) {
      if (this.textures.size <= Lighting.kMostTextures) break;
      this.textures.delete(old);
      texture.then(({id}) => this.gl.deleteTexture(id), () => {});
    }
    return made;
  }

  async load(number) {
    const gl = this.gl, map = this.maps[number], levels = levelsOf(this.maps, number);
    const packed = this.packedFormat(map);
    const pictures = map.packed ? [] : await Promise.all(levels.map(({bytes}) =>
      createImageBitmap(new Blob([bytes], {type: "image/png"}), {premultiplyAlpha: "none", colorSpaceConversion: "none"})));
    const id = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, id);
    levels.forEach(({width, height, bytes}, k) => {
      if (packed) {
        gl.compressedTexImage2D(gl.TEXTURE_2D, k, packed, width, height, 0, bytes);
      } else if (map.packed) {
        gl.texImage2D(gl.TEXTURE_2D, k, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, decodeBlocks(map.format, width, height, bytes));
      } else {
        gl.texImage2D(gl.TEXTURE_2D, k, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, pictures[k]);
      }
    });
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAX_LEVEL, levels.length - 1);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, levels.length > 1 ? gl.LINEAR_MIPMAP_LINEAR : gl.LINEAR);
    return {id, packed: Boolean(packed), signed: Boolean(packed) && map.format === "bc5-snorm"};
  }

  // A promise of the occlusion of map `number`, open if it has none. The GPU decodes it, and makes levels of the mean.
  occlusion(number) {
    if (!this.occlusions.has(number)) this.occlusions.set(number, this.loadOcclusion(number));
    return this.occlusions.get(number);
  }

  async loadOcclusion(number) {
    const gl = this.gl;
    const picture = "occlusion" in this.maps[number] ? await createImageBitmap(new Blob([bytesOf("occlusion-" + number)], {type: "image/png"}))
      : new ImageData(new Uint8ClampedArray([255, 255, 255, 255]), 1, 1);
    const id = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, id);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.SRGB8_ALPHA8, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    gl.generateMipmap(gl.TEXTURE_2D);
    return id;
  }

  // Prepares a program, which is in use, to read map `number` as `name`: "a" or "b".
  setMap(program, name, unit, number, texture, y) {
    const gl = this.gl, map = this.maps[number];
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, texture.id);
    gl.uniform1i(program.uniform("texture" + name.toUpperCase()), unit);
    const channels = map.packed ? map.channels : [0, 1, map.channels[2] < 0 ? -1 : 2];
    ["x", "y", "z"].forEach((c, k) => gl.uniform4fv(program.uniform(name + "." + c), [0, 1, 2, 3].map((n) => (n === channels[k] ? 1 : 0))));
    gl.uniform1f(program.uniform(name + ".scale"), texture.signed ? 1 : 2);
    gl.uniform1f(program.uniform(name + ".offset"), texture.signed ? 0 : -1);
    // Decoded levels have y up if the file says so.
    gl.uniform1f(program.uniform(name + ".sign"), (map.packed ? y === "up" : y === map.y) ? 1 : -1);
    gl.uniform1i(program.uniform(name + ".hasZ"), channels[2] >= 0);
  }

  // Begins a picture with the size of `canvas`, with `program`. Throws if the browser has taken the GPU away.
  begin(canvas, program) {
    const gl = this.gl, {width, height} = canvas;
    if (gl.isContextLost()) throw new Error("the GPU was reset; reload the page");
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, {width, height});
    gl.viewport(0, 0, width, height);
    gl.useProgram(program.id);
  }

  setLight(program, light, point, eye) {
    this.gl.uniform3fv(program.uniform("light"), light);
    this.gl.uniform1i(program.uniform("isPoint"), point);
    this.gl.uniform3fv(program.uniform("eye"), eye);
  }

  // Copies the picture to `canvas`.
  end(canvas) { canvas.getContext("2d", {alpha: false}).drawImage(this.canvas, 0, 0); }

  // Draws `scene` on a plane and copies it to `canvas`: {a, b, yA, yB, split (0 to 1), tiles, bump, light: [x, y, z],
  // point, show}. Returns what the GPU was given.
  async draw(canvas, scene) {
    const textureA = await this.texture(scene.a);
    const textureB = scene.b === null ? textureA : await this.texture(scene.b);
    const open = [await this.occlusion(scene.a), await this.occlusion(scene.b === null ? scene.a : scene.b)];
    const gl = this.gl, program = this.plane, {width, height} = canvas, [w, h] = this.maps[scene.a].levels[0];
    this.begin(canvas, program);
    this.setMap(program, "a", 0, scene.a, textureA, scene.yA);
    this.setMap(program, "b", 1, scene.b === null ? scene.a : scene.b, textureB, scene.b === null ? scene.yA : scene.yB);
    open.forEach((texture, k) => {
      gl.activeTexture(gl.TEXTURE2 + k);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(program.uniform(k === 0 ? "occlusionA" : "occlusionB"), 2 + k);
    });
    this.setLight(program, scene.light, scene.point, kPlaneEye);
    gl.uniform2f(program.uniform("size"), width, height);
    gl.uniform2f(program.uniform("tiles"), scene.tiles, scene.tiles);
    gl.uniform1f(program.uniform("aspect"), w / h);
    gl.uniform1f(program.uniform("edge"), scene.b === null ? width + 1 : scene.split * width);
    gl.uniform1f(program.uniform("bump"), scene.bump);
    gl.uniform1i(program.uniform("show"), scene.show);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    this.end(canvas);
    return textureA;
  }
}
