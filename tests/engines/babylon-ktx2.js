// SPDX-License-Identifier: Apache-2.0
// babylon-ktx2.js: a decoder of KTX2 for Babylon.js, whose own is not on npm: UASTC and ETC1S by the transcoder of
// three.js, as ASTC, BC7, ETC2 or BC1, whichever comes first in the GPU's capabilities, as Babylon.js chooses.

// Transcoder formats, with the numbers of WebGL: of RGB.
const kTargets = [["astc", 10, 0x93b0], ["bptc", 6, 0x8e8c], ["etc2", 0, 0x9274], ["s3tc", 2, 0x83f0]];
const kRgba = [null, 13, 0x8058];

const script = async url => {
  const text = await (await fetch(url)).text();
  return new Function(`${text}\nreturn BASIS;`)();
};
let loading = null;
const load = async () => {
  const BASIS = await script("basis/basis_transcoder.js");
  const module = await BASIS({wasmBinary: await (await fetch("basis/basis_transcoder.wasm")).arrayBuffer()});
  module.initializeBasis();
  return module;
};

export class Decoder {
  async decode(bytes, caps) {
    const module = await (loading ??= load());
    const file = new module.KTX2File(new Uint8Array(bytes));
    try {
      if (!file.isValid() || !file.startTranscoding()) throw "not Basis Universal";
      const [, format, transcodedFormat] = kTargets.find(([name]) => caps[name]) ?? kRgba;
      const mipmaps = [];
      for (let level = 0; level < file.getLevels(); ++level) {
        const {origWidth: width, origHeight: height} = file.getImageLevelInfo(level, 0, 0);
        const data = new Uint8Array(file.getImageTranscodedSizeInBytes(level, 0, 0, format));
        if (!file.transcodeImage(data, level, 0, 0, format, 0, -1, -1)) throw `level ${level} is broken`;
        mipmaps.push({data, width, height});
      }
      return {width: file.getWidth(), height: file.getHeight(), transcodedFormat, mipmaps, isInGammaSpace: false,
              hasAlpha: !!file.getHasAlpha(), transcoderName: "three.js"};
    } finally {
      file.close();
      file.delete();
    }
  }
}
