// SPDX-License-Identifier: Apache-2.0
// engine.rs: what engine.c does, in Rust, with the declarations of tex_c.h written by hand. Prints the same. Fails if the library
// allocates where tex_c.h says that it does not.
use std::ffi::{c_char, c_long, c_void, CStr};
use std::ptr::null_mut;

#[repr(C)]
struct Plane {
    data: *mut f32,
    stride: isize,
    width: i32,
    height: i32,
}

#[repr(C)]
#[derive(Clone, Copy)]
struct Map {
    x: *mut f32,
    y: *mut f32,
    z: *mut f32,
    stride: isize,
    width: i32,
    height: i32,
}
unsafe impl Sync for Map {} // its rows are written by one thread each
unsafe impl Sync for Plane {}

#[repr(C)]
struct Channels {
    channel: [*mut f32; 4],
    stride: isize,
}

#[repr(C)]
struct Texels {
    bytes: *const c_void,
    pitch: usize,
    format: i32,
    width: i32,
    height: i32,
}

#[repr(C)]
struct BakeOptions {
    size: u32,
    kernel: i32,
    gaussian_sigma: f32,
    bumpiness_x: f32,
    bumpiness_y: f32,
    wrap_x: i32,
    wrap_y: i32,
}

#[repr(C)]
struct MipOptions {
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
struct EncodeOptions {
    size: u32,
    encoding: i32,
    effort: i32,
    metric: i32,
    y_axis: i32,
}

#[repr(C)]
struct CheckOptions {
    size: u32,
    swizzle: [u8; 4],
    y_axis: i32,
    tiles: i32,
}

#[repr(C)]
#[derive(Clone, Copy)]
struct Finding {
    size: u32,
    id: [c_char; 8],
    severity: i32,
    level: i32,
    column: i32,
    row: i32,
    figure: f64,
    confidence: f64,
    message: [c_char; 232],
}

#[rustfmt::skip]
#[link(name = "tex")]
extern "C" {
    fn tex_error_text(error: i32) -> *const c_char;
    fn tex_row_bytes(format: i32, width: i32) -> usize;
    fn tex_level_bytes(format: i32, width: i32, height: i32) -> usize;
    fn tex_bake_size(width: i32, height: i32, options: *const BakeOptions) -> usize;
    fn tex_bake(heights: *const Plane, options: *const BakeOptions, first: i32, end: i32, out: *const Map,
                scratch: *mut c_void, scratch_size: usize) -> i32;
    fn tex_mip_size(width: i32, height: i32, options: *const MipOptions) -> usize;
    fn tex_mip_level(from: *const Map, level: i32, options: *const MipOptions, first: i32, end: i32, to: *const Map,
                     scratch: *mut c_void, scratch_size: usize) -> i32;
    fn tex_mip_finish(map: *const Map, level: i32, options: *const MipOptions, first: i32, end: i32) -> i32;
    fn tex_encode_size(width: i32, options: *const EncodeOptions) -> usize;
    fn tex_encode(map: *const Map, options: *const EncodeOptions, first: i32, end: i32, bytes: *mut c_void,
                  pitch: usize, scratch: *mut c_void, scratch_size: usize) -> i32;
    fn tex_decode(texels: *const Texels, first: i32, end: i32, out: *const Channels) -> i32;
    fn tex_check(levels: *const Texels, level_count: i32, options: *const CheckOptions, findings: *mut Finding,
                 capacity: usize, count: *mut usize) -> i32;
}

extern "C" {
    fn allocations_here() -> c_long; // allocations.c
}

const WIDTH: i32 = 160;
const HEIGHT: i32 = 96;
const LEVELS: i32 = 8;
const BC5: i32 = 5; // TEX_FORMAT_BC5_UNORM
const HEADER: usize = 148;
const DXGI_BC5_UNORM: u32 = 83;

fn require(error: i32, what: &str) {
    if error != 0 {
        let text = unsafe { CStr::from_ptr(tex_error_text(error)) };
        panic!("{what}: {}", text.to_string_lossy());
    }
}

fn hash<'a>(bytes: impl Iterator<Item = &'a u8>) -> u64 {
    bytes.fold(14695981039346656037, |sum, byte| (sum ^ u64::from(*byte)).wrapping_mul(1099511628211)) // FNV-1a
}

fn hash_floats(values: &[f32]) -> u64 {
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    hash(bytes.iter())
}

fn extent(level: i32) -> (i32, i32) {
    ((WIDTH >> level).max(1), (HEIGHT >> level).max(1))
}

// Calls rows(first, end, scratch) for bands of rows, on threads of this program.
fn on_threads(rows: i32, scratch_size: usize, what: &str, work: impl Fn(i32, i32, *mut c_void) -> i32 + Sync) {
    let share = (rows + 11) / 12 * 4;
    std::thread::scope(|scope| {
        for first in (0..rows).step_by(share as usize) {
            let work = &work;
            scope.spawn(move || {
                let mut scratch = vec![0u8; scratch_size];
                let before = unsafe { allocations_here() };
                let error = work(first, (first + share).min(rows), scratch.as_mut_ptr().cast());
                assert_eq!(before, unsafe { allocations_here() }, "{what} allocates");
                require(error, what);
            });
        }
    });
}

fn bake(heights: &mut [f32]) -> Vec<u8> {
    let size_of_level = |k| (extent(k).0 * extent(k).1) as usize;
    let mut memory: Vec<Vec<f32>> = (0..LEVELS).map(|k| vec![0.0; 3 * size_of_level(k)]).collect();
    let maps: Vec<Map> = (0..LEVELS)
        .map(|k| {
            let (width, height) = extent(k);
            let (x, step) = (memory[k as usize].as_mut_ptr(), size_of_level(k));
            Map { x, y: x.wrapping_add(step), z: x.wrapping_add(2 * step), stride: width as isize, width, height }
        })
        .collect();
    let size = std::mem::size_of::<BakeOptions>() as u32;
    let options = BakeOptions {
        size, kernel: 2, gaussian_sigma: 1.0, bumpiness_x: 6.0, bumpiness_y: 6.0, wrap_x: 0, wrap_y: 0,
    };
    let plane = Plane { data: heights.as_mut_ptr(), stride: WIDTH as isize, width: WIDTH, height: HEIGHT };
    let scratch = unsafe { tex_bake_size(WIDTH, HEIGHT, &options) };
    on_threads(HEIGHT, scratch, "tex_bake", |first, end, memory| unsafe {
        tex_bake(&plane, &options, first, end, &maps[0], memory, scratch)
    });

    let size = std::mem::size_of::<MipOptions>() as u32;
    let mip = MipOptions { size, filter: 0, domain: 0, wrap_x: 0, wrap_y: 0, fade_first: 0, fade_last: 0, any_z: 0 };
    for k in 0..LEVELS {
        let map = &maps[k as usize];
        if let Some(next) = maps.get(k as usize + 1) {
            let scratch = unsafe { tex_mip_size(map.width, map.height, &mip) };
            on_threads(next.height, scratch, "tex_mip_level", |first, end, memory| unsafe {
                tex_mip_level(map, k, &mip, first, end, next, memory, scratch)
            });
        }
        if k > 0 {
            on_threads(map.height, 0, "tex_mip_finish", |first, end, _| unsafe {
                tex_mip_finish(map, k, &mip, first, end)
            });
        }
    }

    let size = std::mem::size_of::<EncodeOptions>() as u32;
    let encode = EncodeOptions { size, encoding: 1, effort: 1, metric: 0, y_axis: 0 };
    let mut file = vec![0u8; HEADER];
    file[0..4].copy_from_slice(b"DDS ");
    file[84..88].copy_from_slice(b"DX10");
    for (at, value) in [(4, 124), (12, HEIGHT as u32), (16, WIDTH as u32), (28, LEVELS as u32), (76, 32), (80, 4),
                        (128, DXGI_BC5_UNORM), (132, 3), (140, 1)] {
        file[at..at + 4].copy_from_slice(&u32::to_le_bytes(value));
    }
    for map in &maps {
        let pitch = unsafe { tex_row_bytes(BC5, map.width) };
        let mut level = vec![0u8; unsafe { tex_level_bytes(BC5, map.width, map.height) }];
        let scratch = unsafe { tex_encode_size(map.width, &encode) };
        let bytes = level.as_mut_ptr() as usize;
        on_threads(map.height, scratch, "tex_encode", |first, end, memory| unsafe {
            tex_encode(map, &encode, first, end, bytes as *mut c_void, pitch, memory, scratch)
        });
        file.extend(level);
    }
    file
}

fn get32(file: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(file[at..at + 4].try_into().unwrap())
}

fn decode(file: &[u8]) -> (Vec<Texels>, Vec<f32>, Vec<f32>) {
    assert!(&file[84..88] == b"DX10" && get32(file, 128) == DXGI_BC5_UNORM);
    let (mut levels, mut red, mut green) = (Vec::new(), Vec::new(), Vec::new());
    let mut at = HEADER;
    for k in 0..get32(file, 28) {
        let width = (get32(file, 16) as i32 >> k).max(1);
        let height = (get32(file, 12) as i32 >> k).max(1);
        let pitch = unsafe { tex_row_bytes(BC5, width) };
        let bytes = file[at..].as_ptr().cast();
        let texels = Texels { bytes, pitch, format: BC5, width, height };
        let mut planes = vec![vec![0f32; (width * height) as usize]; 2];
        let channel = [planes[0].as_mut_ptr(), planes[1].as_mut_ptr(), null_mut(), null_mut()];
        let out = Channels { channel, stride: width as isize };
        let before = unsafe { allocations_here() };
        require(unsafe { tex_decode(&texels, 0, height, &out) }, "tex_decode");
        assert_eq!(before, unsafe { allocations_here() }, "tex_decode allocates");
        red.extend(&planes[0]);
        green.extend(&planes[1]);
        at += unsafe { tex_level_bytes(BC5, width, height) };
        levels.push(texels);
    }
    (levels, red, green)
}

fn check(levels: &[Texels], y_axis: i32) {
    let size = std::mem::size_of::<CheckOptions>() as u32;
    let options = CheckOptions { size, swizzle: [2, 3, 0, 1], y_axis, tiles: 1 };
    let size = std::mem::size_of::<Finding>() as u32;
    let none = Finding {
        size, id: [0; 8], severity: 0, level: 0, column: 0, row: 0, figure: 0.0, confidence: 0.0, message: [0; 232],
    };
    let mut findings = [none; 16];
    let mut count = 0;
    let level_count = levels.len() as i32;
    let before = unsafe { allocations_here() };
    require(unsafe { tex_check(levels.as_ptr(), level_count, &options, null_mut(), 0, &mut count) }, "tex_check");
    assert_ne!(before, unsafe { allocations_here() }, "tex_check says that it allocates: nothing is counted");
    assert!(count <= findings.len());
    let out = if count == 0 { null_mut() } else { findings.as_mut_ptr() };
    require(unsafe { tex_check(levels.as_ptr(), level_count, &options, out, count, &mut count) }, "tex_check");
    println!("{count} findings");
    for finding in &findings[..count] {
        let text = |chars: &[c_char]| unsafe { CStr::from_ptr(chars.as_ptr()) }.to_string_lossy().into_owned();
        let severity = ["note", "warning", "error"][finding.severity as usize];
        println!("{} {severity}, level {}: {}", text(&finding.id), finding.level, text(&finding.message));
    }
}

fn main() {
    let wave = |i: i32| (i % 32) as f32 / 32.0;
    let mut heights = Vec::new();
    for j in 0..HEIGHT {
        for i in 0..WIDTH {
            let (u, v) = (wave(i), wave(j));
            heights.push(16.0 * u * (1.0 - u) * v * (1.0 - v));
        }
    }
    let file = bake(&mut heights);
    println!("baked {:016x}", hash(file[HEADER..].iter()));
    let (levels, red, green) = decode(&file);
    println!("decoded {:016x} {:016x}", hash_floats(&red), hash_floats(&green));
    check(&levels, -1);
    check(&levels, 1);
}
