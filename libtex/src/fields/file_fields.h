// SPDX-License-Identifier: Apache-2.0
// file_fields.h: the fields of file.h.

#pragma once

#include <tex/file.h>

#include "fields/field.h"

namespace tex::inline v1 {

template <Of<WriteOptions> O, class F>
void each_field(O& o, F& f) {
    f("dds_header", o.dds_header, kDdsHeaderNames);
    f("dds_mark", o.dds_mark);
    f("zstd", o.zstd, Range{0, kHighestZstdLevel});
    f("jpeg_quality", o.jpeg_quality, Range{1, 100});
    f("sync", o.sync);
    f("no_clobber", o.no_clobber);
    f("follow_links", o.follow_links);
    f("reader", o.reader);
}

template <Of<ReadOptions> O, class F>
void each_field(O& o, F& f) {
    f("max_texels", o.max_texels, kAtLeastOne);
    f("layer", o.layer);
    f("values", o.values, kFileValuesNames);
    f("raw", o.raw);
    f("reader", o.reader);
    f("reader_memory", o.reader_memory, kAtLeastOne);
    f("reader_timeout", o.reader_timeout, kAtLeastOne);
}

}  // namespace tex::inline v1
