// SPDX-License-Identifier: Apache-2.0
// BakeToBc5.cs: bake_to_bc5.c in C#, through P/Invoke: for Unity, Godot and .NET. The tests compile it with mono's mcs
// where that is installed.
//
//     mcs -unsafe BakeToBc5.cs && mono BakeToBc5.exe

using System;
using System.Runtime.InteropServices;

static unsafe class BakeToBc5 {
    const string Library = "libtex.so.1";
    const int Side = 64, Levels = 7, Bc5Unorm = 5;

    [StructLayout(LayoutKind.Sequential)]
    struct Plane {
        public float* Data;
        public IntPtr Stride;
        public int Width, Height;
    }

    [StructLayout(LayoutKind.Sequential)]
    struct Map {
        public float* X, Y, Z;
        public IntPtr Stride;
        public int Width, Height;
    }

    [StructLayout(LayoutKind.Sequential)]
    struct BakeOptions {
        public uint Size;
        public int Kernel;
        public float GaussianSigma, BumpinessX, BumpinessY;
        public int WrapX, WrapY;
    }

    [StructLayout(LayoutKind.Sequential)]
    struct MipOptions {
        public uint Size;
        public int Filter, Domain, WrapX, WrapY, FadeFirst, FadeLast, AnyZ;
    }

    [StructLayout(LayoutKind.Sequential)]
    struct EncodeOptions {
        public uint Size;
        public int Encoding, Effort, Metric, YAxis;
    }

    [DllImport(Library)] static extern IntPtr tex_error_text(int error);
    [DllImport(Library)] static extern UIntPtr tex_row_bytes(int format, int width);
    [DllImport(Library)] static extern UIntPtr tex_level_bytes(int format, int width, int height);
    [DllImport(Library)] static extern UIntPtr tex_bake_size(int width, int height, ref BakeOptions options);
    [DllImport(Library)] static extern int tex_bake(ref Plane heights, ref BakeOptions options, int first, int end,
                                                    ref Map map, byte* scratch, UIntPtr size);
    [DllImport(Library)] static extern UIntPtr tex_mip_size(int width, int height, ref MipOptions options);
    [DllImport(Library)] static extern int tex_mip_level(ref Map from, int level, ref MipOptions options, int first,
                                                         int end, ref Map to, byte* scratch, UIntPtr size);
    [DllImport(Library)] static extern int tex_mip_finish(ref Map map, int level, ref MipOptions options, int first,
                                                          int end);
    [DllImport(Library)] static extern int tex_encode(ref Map map, ref EncodeOptions options, int first, int end,
                                                      byte* bytes, UIntPtr pitch, byte* scratch, UIntPtr size);

    static void Check(int error) {
        if (error != 0) throw new Exception(Marshal.PtrToStringAnsi(tex_error_text(error)));
    }

    static void Main() {
        var heights = (float*)Marshal.AllocHGlobal(Side * Side * 4);
        for (int j = 0; j < Side; ++j)
            for (int i = 0; i < Side; ++i) heights[j * Side + i] = (i * 7 + j * j * 3) % 64 / 64f;
        var plane = new Plane { Data = heights, Stride = (IntPtr)Side, Width = Side, Height = Side };
        var maps = new Map[Levels];
        for (int level = 0; level < Levels; ++level) {
            int side = Side >> level, count = side * side;
            var memory = (float*)Marshal.AllocHGlobal(3 * count * 4);
            maps[level] = new Map { X = memory, Y = memory + count, Z = memory + 2 * count, Stride = (IntPtr)side,
                                    Width = side, Height = side };
        }
        var bake = new BakeOptions { Size = (uint)sizeof(BakeOptions), Kernel = 1, GaussianSigma = 1, BumpinessX = 4,
                                     BumpinessY = 4 };
        var mip = new MipOptions { Size = (uint)sizeof(MipOptions) };
        var encode = new EncodeOptions { Size = (uint)sizeof(EncodeOptions), Encoding = 1, Effort = 1 };
        ulong size = Math.Max((ulong)tex_bake_size(Side, Side, ref bake), (ulong)tex_mip_size(Side, Side, ref mip));
        var scratch = (byte*)Marshal.AllocHGlobal((int)size);
        Check(tex_bake(ref plane, ref bake, 0, Side / 2, ref maps[0], scratch, (UIntPtr)size));
        Check(tex_bake(ref plane, ref bake, Side / 2, Side, ref maps[0], scratch, (UIntPtr)size));
        for (int level = 0; level + 1 < Levels; ++level) {
            Check(tex_mip_level(ref maps[level], level, ref mip, 0, maps[level + 1].Height, ref maps[level + 1], scratch,
                                (UIntPtr)size));
            if (level > 0) Check(tex_mip_finish(ref maps[level], level, ref mip, 0, maps[level].Height));
        }
        Check(tex_mip_finish(ref maps[Levels - 1], Levels - 1, ref mip, 0, 1));
        ulong sum = 14695981039346656037, total = 0;
        for (int level = 0; level < Levels; ++level) {
            int side = Side >> level;
            ulong count = (ulong)tex_level_bytes(Bc5Unorm, side, side);
            var blocks = (byte*)Marshal.AllocHGlobal((int)count);
            Check(tex_encode(ref maps[level], ref encode, 0, side, blocks, tex_row_bytes(Bc5Unorm, side), null,
                             UIntPtr.Zero));
            for (ulong k = 0; k < count; ++k) sum = unchecked((sum ^ blocks[k]) * 1099511628211);
            total += count;
        }
        Console.WriteLine("{0} bytes of BC5, sum {1:x16}", total, sum);
    }
}
