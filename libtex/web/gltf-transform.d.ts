import type { Document, Extension, Texture, Transform } from '@gltf-transform/core';
import type { CheckOptions, Finding } from './index.js';

/** sharp, or what takes its place: decodes JPEG, WebP and AVIF. */
type Decoder = (image: Uint8Array) => any;

export function checkNormals(options?: CheckOptions & {
    decoder?: Decoder;
    onFinding?: (texture: Texture, finding: Finding) => void;
    /** An error ends the transformation. */
    fail?: boolean;
}): Transform;
export function normals(options: {
    format?: 'uastc' | 'png';
    /** Halves a map until no side has more texels. */
    resize?: number;
    /** The mean angle in degrees that UASTC may add to compress better. */
    rdo?: number;
    effort?: 'fast' | 'normal' | 'best';
    zstd?: number;
    decoder?: Decoder;
    /** KHRTextureBasisu of @gltf-transform/extensions. */
    basisu?: new (document: Document) => Extension;
}): Transform;
