// SPDX-License-Identifier: Apache-2.0
// What JavaScript calls (index.js): memory for arguments, and one function for all verbs, from JSON to JSON.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <optional>
#include <stdexcept>

#include "values.h"

namespace tex::web {
namespace {

template <class T>
T options_from(const Json& call) {
    T options;
    const Json* const given = call.find("options");
    if (given == nullptr) return options;
    Reader reader(*given);
    each_field(options, reader);
    reader.finish();
    return options;
}

std::string file_name(const Json& call) {
    const Json* const name = call.find("name");
    return name != nullptr ? text_from(*name, "name") : std::string();
}

Json baked(const Json& call, Answer& answer) {
    const auto options = options_from<BakeKeywords>(call);
    HeightField field;
    field.height = plane_from(member(call, "heights"), "heights");
    field.bumpiness_x = options.bumpiness_x;
    field.bumpiness_y = options.bumpiness_y;
    field.wrap_x = options.wrap_x;
    field.wrap_y = options.wrap_y;
    return answer.of(sound(bake(field, options)));
}

Json heights(const Json& call, Answer& answer) {
    const auto options = options_from<HeightOptions>(call);
    const Image image = sound(read_image(bytes_from(member(call, "bytes"), "bytes"), file_name(call)));
    const PictureHeights field = sound(height_field(image, options));
    Json result = answer.of(field.height);
    result.set("bumpiness", Json::list({field.bumpiness_x, field.bumpiness_y}));
    return result;
}

Json levels(const Json& call, Answer& answer) {
    const auto options = options_from<MipKeywords>(call);
    return answer.of(sound(build_mip_chain(map_from(member(call, "map"), "map"), options)));
}

Json scaled(const Json& call, Answer& answer) {
    const auto options = options_from<Scaling>(call);
    const Json& given = member(call, "map");
    const MipChain chain = sound(scale(chain_from(given, "map"), options.scale, options.mode));
    return given.is_list() ? answer.of(chain) : answer.of(chain.levels.front());
}

Json blended(const Json& call, Answer& answer) {
    const auto options = options_from<BlendOptions>(call);
    constexpr std::int64_t kMostTexels = std::int64_t{1} << 27;  // sizes fit std::size_t, which has 32 bits
    if (options.extent.texels() > kMostTexels) fail("extent: more texels than fit memory", ErrorCode::out_of_memory);
    std::vector<Layer> layers;
    for (const Json& given : list_from(member(call, "layers"), "layers")) {
        const std::string name = "layers[" + std::to_string(layers.size()) + "]";
        Layer layer;
        layer.detail = chain_from(member(given, "detail"), name + ".detail");
        if (const Json* const mask = given.find("mask")) layer.mask = plane_from(*mask, name + ".mask");
        Reader reader(given);
        reader.leave("detail");
        reader.leave("mask");
        each_field(layer, reader);
        reader.finish();
        layers.push_back(std::move(layer));
    }
    return answer.of(sound(blend(chain_from(member(call, "base"), "base"), std::move(layers), options)));
}

Json packed(const Json& call, Answer& answer) {
    const auto options = options_from<PackKeywords>(call);
    return answer.of(Texture(sound(pack(chain_from(member(call, "map"), "map"), options))));
}

Json unpacked(const Json& call, Answer& answer) {
    const auto options = options_from<UnpackKeywords>(call);
    return answer.of(sound(unpack(texture_from(member(call, "texture")), options)));
}

Json read(const Json& call, Answer& answer) {
    return answer.of(sound(read_texture(bytes_from(member(call, "bytes"), "bytes"), file_name(call))));
}

Json encoded(const Json& call, Answer& answer) {
    const auto options = options_from<EncodeKeywords>(call);
    return answer.of(sound(encode_file(texture_from(member(call, "texture")), options.container, options)));
}

Json checked(const Json& call, Answer&) {
    CheckOptions options;
    const Json given = value_or_null(call, "options");
    if (!given.is_null() && !given.is_object()) fail("options: expected an object");
    for (std::size_t k = 0; k < given.keys().size(); ++k) {
        const std::string& key = given.keys()[k];
        const Json& value = given.elements()[k];
        if (!value.is_list()) fail(key + ": expected a list of strings");
        for (const Json& word : value.elements()) {
            const std::string& text = text_from(word, key);
            if (key == "require") {
                sound_or_throw(add_requirement(options.require, text));
            } else if (key == "enable") {
                options.enable.push_back(text);
            } else if (key == "disable") {
                options.disable.push_back(text);
            } else {
                fail("unknown option '" + key + "'");
            }
        }
    }
    const std::string name = file_name(call);
    const Json* const bytes = call.find("bytes");
    const Texture texture = bytes != nullptr ? sound(read_texture(bytes_from(*bytes, "bytes"), name))
                                             : texture_from(member(call, "texture"));
    const CheckReport report = sound(check(name, texture, options));
    Json findings = Json::list();
    for (const Finding& finding : report.findings) {
        Json found = {{"id", finding.rule->id},
                      {"name", finding.rule->name},
                      {"severity", name_of(kSeverityNames, finding.severity)},
                      {"message", finding.message},
                      {"fix", finding.rule->fix},
                      {"figure", finding.figure},
                      {"unit", finding.unit},
                      {"confidence", finding.confidence},
                      {"level", finding.regions.empty() ? 0 : finding.regions.front().level}};
        if (finding.has_texel) found.set("texel", Json::list({finding.column, finding.row}));
        findings.append(std::move(found));
    }
    return findings;
}

Json compared(const Json& call, Answer& answer) {
    const NormalMap a = map_from(member(call, "a"), "a"), b = map_from(member(call, "b"), "b");
    if (a.extent() != b.extent()) fail("b: must have the extent of a");
    const Comparison comparison = sound(compare(a, b));
    const AngularError& error = comparison.error;
    return {{"mean", error.mean},
            {"rms", error.rms},
            {"p50", error.p50},
            {"p99", error.p99},
            {"p999", error.p999},
            {"max", error.max},
            {"degrees", answer.of(comparison.degrees)}};
}

template <class T>
std::string interface(const char* name) {
    T options;
    Lister lister;
    each_field(options, lister);
    return std::string("export interface ") + name + " {\n" + lister.members + "}\n\n";
}

// The options of all verbs as TypeScript: npm.sh puts them into index.d.ts.
Json declarations(const Json&, Answer&) {
    return interface<HeightOptions>("HeightOptions") + interface<BakeKeywords>("BakeOptions") +
           interface<MipKeywords>("MipOptions") + interface<Scaling>("ScaleOptions") +
           interface<BlendOptions>("BlendOptions") + interface<Layer>("LayerOptions") +
           interface<PackKeywords>("PackOptions") + interface<UnpackKeywords>("UnpackOptions") +
           interface<EncodeKeywords>("EncodeOptions");
}

Json versions(const Json&, Answer&) { return {{"version", version()}, {"instruction_set", runtime().instruction_set}}; }

struct Verb {
    const char* name;
    Json (*run)(const Json& call, Answer& answer);
};
constexpr Verb kVerbs[] = {
    {"bake", baked},       {"readHeights", heights}, {"mip", levels},       {"scale", scaled},
    {"blend", blended},    {"pack", packed},         {"unpack", unpacked},  {"readTexture", read},
    {"encode", encoded},   {"check", checked},       {"compare", compared}, {"declarations", declarations},
    {"version", versions},
};

Json error_of(const Error& error) {
    return {{"code", name_of(kErrorCodeNames, error.code)}, {"message", error.message()}};
}

Json answer_to(const std::optional<Json>& parsed, Answer& answer) {
    try {
        if (!parsed) fail("options: nested too deeply");
        const Json& call = *parsed;
        const std::string& name = text_from(member(call, "verb"), "verb");
        for (const Verb& verb : kVerbs) {
            if (name == verb.name) return {{"value", verb.run(call, answer)}};
        }
        fail("there is no verb " + name);
    } catch (const Failure& failure) {
        return {{"error", error_of(failure.error)}};
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {
    }
    return {{"error", error_of({ErrorCode::out_of_memory, {}, "out of memory"})}};
}

Answer* last = nullptr;
std::string text;

}  // namespace
}  // namespace tex::web

extern "C" {

__attribute__((export_name("tex_allocate"))) void* tex_allocate(std::size_t bytes) { return std::malloc(bytes); }
__attribute__((export_name("tex_free"))) void tex_free(void* memory) { std::free(memory); }

// The answer is a text that ends with 0. It and its arrays live until tex_done().
__attribute__((export_name("tex_call"))) const char* tex_call(const char* call) {
    using namespace tex::web;
    delete last;
    last = new Answer;
    text = answer_to(Json::parse(call), *last).dump();
    return text.c_str();
}
__attribute__((export_name("tex_done"))) void tex_done() {
    delete tex::web::last;
    tex::web::last = nullptr;
    tex::web::text = {};
}
}
