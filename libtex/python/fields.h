// SPDX-License-Identifier: Apache-2.0
// fields.h: the fields of the option structures, with their names in the headers. They become keyword arguments, whose
// defaults are the structures' own. A structure inside another one becomes a dict.

#pragma once

#include <cmath>

#include <tex/tex.h>

#include "arguments.h"

namespace tex::python {

// The bumpiness and wrap of a HeightField.
struct Relief {
    std::optional<float> bumpiness_x, bumpiness_y;
    std::optional<Wrap> wrap_x, wrap_y;
};

template <class F>
void each_field(Relief& o, F& f) {
    f("bumpiness", axes(o.bumpiness_x, o.bumpiness_y));
    f("wrap", axes(o.wrap_x, o.wrap_y));
}

template <class F>
void each_field(BakeOptions& o, F& f) {
    f("kernel", o.kernel);
    f("gaussian_sigma", o.gaussian_sigma);
}

template <class F>
void each_field(HeightOptions& o, F& f) {
    f("channel", o.channel);
    f("channel_name", o.channel_name);
    f("no_data", o.no_data);
    f("fill_invalid", o.fill_invalid);
    f("invert", o.invert);
    f("deband", o.deband);
    f("blur_sigma", o.blur_sigma);
    f("wrap", axes(o.wrap_x, o.wrap_y));
}

// The options of mip levels, but for those about data beside the normals.
template <class F>
void level_fields(MipOptions& o, F& f) {
    f("levels", o.levels);
    f("filter", o.filter);
    f("domain", o.domain);
    f("fade", o.fade);
    f("wrap", axes(o.wrap_x, o.wrap_y));
    f("max_side", o.max_side);
    f("any_z", o.any_z);
}

template <class F>
void each_field(MipOptions& o, F& f) {
    level_fields(o, f);
    f("blue", o.blue);
    f("alpha", o.alpha);
    f("roughness", o.roughness);
}

template <class F>
void each_field(IntegrateOptions& o, F& f) {  // besides those of BakeOptions
    f("bumpiness", axes(o.bumpiness_x, o.bumpiness_y));
    f("wrap", axes(o.wrap_x, o.wrap_y));
    f("least_z", o.least_z);
    f("least_response", o.least_response);
    f("most_steps", o.most_steps);
}

template <class F>
void each_field(CurvatureOptions& o, F& f) {
    f("kind", o.kind);
    f("wrap", axes(o.wrap_x, o.wrap_y));
}

template <class F>
void each_rdo_field(RdoOptions& o, F& f) {
    f("rdo_mean", o.mean);
    f("rdo_max", o.max);
    f("rdo_window", o.window);
}

template <class F>
void each_field(PackOptions& o, F& f) {
    f("encoding", o.encoding);
    f("y_axis", o.y_axis);
    f("effort", o.effort);
    f("metric", o.metric);
    f("y_known", o.y_known);
    each_rdo_field(o.rdo, f);
}

template <class F>
void each_field(UnpackOptions& o, F& f) {
    f("swizzle", o.swizzle);
    f("y_axis", o.y_axis);
    f("range", o.range);
    f("snap_flat", o.snap_flat);
    f("keep_length", o.keep_length);
    f("keep_invalid", o.keep_invalid);
    f("others", o.others);
}

template <class F>
void each_field(Scaling& o, F& f) {
    f("scale", o.scale);
    f("mode", o.mode);
}

template <class F>
void each_field(BlendOptions& o, F& f) {
    f("mode", o.mode);
    f("base_scale", o.base_scale);
    f("scale_mode", o.scale_mode);
    f("extent", o.extent);
    f("wrap", axes(o.wrap_x, o.wrap_y));
}

// Layer and LayerFile have these fields.
template <class L, class F>
void each_placement(L& o, F& f) {
    f("scale", o.scale);
    f("tiling", axes(o.tiling_x, o.tiling_y));
    f("offset", axes(o.offset_x, o.offset_y));
    f("rotation", o.rotation);
    f("wrap", axes(o.wrap_x, o.wrap_y));
    f("strength", o.strength);
}

template <class F>
void each_field(ReadOptions& o, F& f) {
    f("max_texels", o.max_texels);
    f("layer", o.layer);
    f("values", o.values);
    f("raw", o.raw);
    f("reader", o.reader);
    f("reader_memory", o.reader_memory);
    f("reader_timeout", o.reader_timeout);
    if constexpr (requires { f.finish(std::string()); }) {  // they are read, not listed
        need(o.max_texels >= 1, "max_texels", "must be 1 or more");
        need(o.reader_memory >= 1, "reader_memory", "must be 1 byte or more");
        need(o.reader_timeout >= 1, "reader_timeout", "must be 1 second or more");
    }
}

template <class F>
void each_field(ColorOptions& o, F& f) {
    f("space", o.space);
    f("config", o.config);
}

template <class F>
void each_field(WriteOptions& o, F& f) {
    f("dds_header", o.dds_header);
    f("dds_mark", o.dds_mark);
    f("zstd", o.zstd);
    f("jpeg_quality", o.jpeg_quality);
    f("sync", o.sync);
    f("no_clobber", o.no_clobber);
    f("follow_links", o.follow_links);
    f("reader", o.reader);
}

template <class F>
void each_field(SourceOptions& o, F& f) {
    f("read", o.read);
    f("unpack", o.unpack);
    f("bc5_swizzle", o.bc5_swizzle);
    f("r_or_a", o.r_or_a);
    f("doubt_y", o.doubt_y);
    f("inspect", o.inspect);
    f("drop_others", o.drop_others);
    f("fill_background", o.fill_background);
    f("measure_y", o.measure_y);
    f("file_y_first", o.file_y_first);
}

template <class F>
void each_field(Light& o, F& f) {
    f("kind", o.kind);
    f("x", o.x);
    f("y", o.y);
    f("z", o.z);
    f("color", o.color);
}

template <class F>
void each_field(Material& o, F& f) {
    f("albedo", o.albedo);
    f("specular", o.specular);
    f("shininess", o.shininess);
    f("model", o.model);
}

template <class F>
void each_field(Camera& o, F& f) {
    f("yaw", o.yaw);
    f("pitch", o.pitch);
    f("field_of_view", o.field_of_view);
}

template <class F>
void each_field(Detail& o, F& f) {
    f("tiling", axes(o.tiling_x, o.tiling_y));
    f("offset", axes(o.offset_x, o.offset_y));
    f("scale", o.scale);
}

template <class F>
void each_field(Parallax& o, F& f) {
    f("amount", o.amount);
    f("limit", o.limit);
    f("steps", o.steps);
}

template <class F>
void each_field(PreviewOptions& o, F& f) {
    f("show", o.show);
    f("size", o.size);
    f("shape", o.shape);
    f("tiles", axes(o.tiles_x, o.tiles_y));
    f("mirror", o.mirror);
    f("spin", o.spin);
    f("camera", o.camera);
    f("light", o.light);
    f("ambient", o.ambient);
    f("material", o.material);
    f("bump_scale", o.bump_scale);
    f("scale_mode", o.scale_mode);
    f("detail", o.detail);
    f("parallax", o.parallax);
    f("wrap", axes(o.wrap_x, o.wrap_y));
    f("anisotropy", o.anisotropy);
    f("maximum", o.maximum);
    f("legend", o.legend);
}

// How a file is packed: what is not given follows from the file.
struct PackFields {
    std::optional<Encoding> encoding;
    std::optional<YAxis> y_axis;
    Effort effort = PackOptions().effort;
    Metric metric = PackOptions().metric;
    RdoOptions rdo;
};

template <class F>
void each_field(PackFields& o, F& f) {
    f("encoding", o.encoding);
    f("y_axis", o.y_axis);
    f("effort", o.effort);
    f("metric", o.metric);
    each_rdo_field(o.rdo, f);
}

// The fields of SourceInfo.
py::dict describe(const SourceInfo& info);

}  // namespace tex::python
