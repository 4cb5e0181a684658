// SPDX-License-Identifier: Apache-2.0
// bake_and_pack HEIGHT OUTPUT.dds: what bake-normals does, in your own program.
#include <tex/tex.h>

#include <cstdio>

static int fail(const tex::Error& error) {
    std::fprintf(stderr, "bake_and_pack: error: %s\n", error.message().c_str());
    return 1;
}

int main(int argc, char** argv) {
    if (argc != 3) return std::fprintf(stderr, "usage: bake_and_pack HEIGHT OUTPUT.dds\n"), 2;

    auto image = tex::read_image(argv[1]);
    if (!image) return fail(image.error());
    auto field = tex::height_field(*image, {});
    if (!field) return fail(field.error());
    field->bumpiness_x = field->bumpiness_y = 12.0f;  // value 1.0 is 12 texels high

    auto normals = tex::bake(*field);
    if (!normals) return fail(normals.error());
    auto chain = tex::build_mip_chain(std::move(*normals));
    if (!chain) return fail(chain.error());
    auto texture = tex::pack(*chain, {tex::Encoding::dxt5nm});
    if (!texture) return fail(texture.error());
    auto written = tex::write_texture(argv[2], *texture);
    if (!written) return fail(written.error());
}
