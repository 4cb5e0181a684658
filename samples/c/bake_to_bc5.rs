// SPDX-License-Identifier: Apache-2.0
// bake_to_bc5.rs: bake_to_bc5.c in Rust, with the declarations of tex_c.h that it needs written by hand.
//
//     rustc --edition 2021 bake_to_bc5.rs -L LIBRARY_FOLDER

use std::ffi::{c_char, c_void, CStr};
use std::ptr::null_mut;

#[repr(C)]
struct TexPlane {
    data: *mut f32,
    stride: isize,
    width: i32,
    height: i32,
}

#[repr(C)]
struct TexMap {
    x: *mut f32,
    y: *mut f32,
    z: *mut f32,
    stride: isize,
    width: i32,
    height: i32,
}

#[repr(C)]
struct TexBakeOptions {
    size: u32,
    kernel: i32,
    gaussian_sigma: f32,
    bumpiness_x: f32,
    bumpiness_y: f32,
    wrap_x: i32,
    wrap_y: i32,
}

#[repr(C)]
#[derive(Default)]
struct TexMipOptions {
    size: u32,
    filter: i32,
    domain: i32,
    wrap_x: i32,
    wrap_y: i32,
    fade_first: i32,
    fade_last: i32,
    any_z: i32,
}

#[repr(C)]
struct TexEncodeOptions {
    size: u32,
    encoding: i32,
    effort: i32,
    metric: i32,
    y_axis: i32,
}

const TEX_KERNEL_CENTRAL: i32 = 1;
const TEX_ENCODING_BC5: i32 = 1;
const TEX_EFFORT_NORMAL: i32 = 1;
const TEX_FORMAT_BC5_UNORM: i32 = 5;

#[rustfmt::skip]
#[link(name = "tex")]
extern "C" {
    fn tex_error_text(error: i32) -> *const c_char;
    fn tex_row_bytes(format: i32, width: i32) -> usize;
    fn tex_level_bytes(format: i32, width: i32, height: i32) -> usize;
    fn tex_bake_size(width: i32, height: i32, options: *const TexBakeOptions) -> usize;
    fn tex_bake(heights: *const TexPlane, options: *const TexBakeOptions, first: i32, end: i32, out: *const TexMap,
                scratch: *mut c_void, scratch_size: usize) -> i32;
    fn tex_mip_size(width: i32, height: i32, options: *const TexMipOptions) -> usize;
    fn tex_mip_level(from: *const TexMap, level: i32, options: *const TexMipOptions, first: i32, end: i32,
                     to: *const TexMap, scratch: *mut c_void, scratch_size: usize) -> i32;
    fn tex_mip_finish(map: *const TexMap, level: i32, options: *const TexMipOptions, first: i32, end: i32) -> i32;
    fn tex_encode(map: *const TexMap, options: *const TexEncodeOptions, first: i32, end: i32, bytes: *mut c_void,
                  pitch: usize, scratch: *mut c_void, scratch_size: usize) -> i32;
}

// The texels of a level.
struct Normals {
    planes: [Vec<f32>; 3],
    side: i32,
}

impl Normals {
    fn new(side: i32) -> Normals {
        let plane = || vec![0.0; (side * side) as usize];
        Normals { planes: [plane(), plane(), plane()], side }
    }
    fn map(&mut self) -> TexMap {
        let [x, y, z] = self.planes.each_mut().map(|plane| plane.as_mut_ptr());
        TexMap { x, y, z, stride: self.side as isize, width: self.side, height: self.side }
    }
}

fn check(error: i32) {
    if error != 0 {
        panic!("{}", unsafe { CStr::from_ptr(tex_error_text(error)) }.to_string_lossy());
    }
}

fn main() {
    const SIDE: i32 = 64;
    let mut height: Vec<f32> = Vec::new();
    for j in 0..SIDE {
        for i in 0..SIDE {
            height.push(((i * 7 + j * j * 3) % 64) as f32 / 64.0);
        }
    }
    let mut levels: Vec<Normals> = (0..7).map(|level| Normals::new(SIDE >> level)).collect();
    let maps: Vec<TexMap> = levels.iter_mut().map(Normals::map).collect();

    let heights = TexPlane { data: height.as_mut_ptr(), stride: SIDE as isize, width: SIDE, height: SIDE };
    let bake = TexBakeOptions {
        size: std::mem::size_of::<TexBakeOptions>() as u32,
        kernel: TEX_KERNEL_CENTRAL,
        gaussian_sigma: 1.0,
        bumpiness_x: 4.0,
        bumpiness_y: 4.0,
        wrap_x: 0,
        wrap_y: 0,
    };
    let mip = TexMipOptions { size: std::mem::size_of::<TexMipOptions>() as u32, ..Default::default() };
    let encode = TexEncodeOptions {
        size: std::mem::size_of::<TexEncodeOptions>() as u32,
        encoding: TEX_ENCODING_BC5,
        effort: TEX_EFFORT_NORMAL,
        metric: 0,
        y_axis: 0,
    };
    let mut sum: u64 = 14695981039346656037;
    let mut bytes = 0;
    unsafe {
        let size = tex_bake_size(SIDE, SIDE, &bake).max(tex_mip_size(SIDE, SIDE, &mip));
        let mut memory = vec![0u8; size];
        let scratch = memory.as_mut_ptr() as *mut c_void;
        check(tex_bake(&heights, &bake, 0, SIDE / 2, &maps[0], scratch, size));
        check(tex_bake(&heights, &bake, SIDE / 2, SIDE, &maps[0], scratch, size));
        for level in 0..6 {
            let to = &maps[level + 1];
            check(tex_mip_level(&maps[level], level as i32, &mip, 0, to.height, to, scratch, size));
            if level > 0 {
                check(tex_mip_finish(&maps[level], level as i32, &mip, 0, maps[level].height));
            }
        }
        check(tex_mip_finish(&maps[6], 6, &mip, 0, 1));
        for map in &maps {
            let mut blocks = vec![0u8; tex_level_bytes(TEX_FORMAT_BC5_UNORM, map.width, map.height)];
            let pitch = tex_row_bytes(TEX_FORMAT_BC5_UNORM, map.width);
            let to = blocks.as_mut_ptr() as *mut c_void;
            check(tex_encode(map, &encode, 0, map.height, to, pitch, null_mut(), 0));
            sum = blocks.iter().fold(sum, |s, &byte| (s ^ byte as u64).wrapping_mul(1099511628211));
            bytes += blocks.len();
        }
    }
    println!("{} bytes of BC5, sum {:016x}", bytes, sum);
}
