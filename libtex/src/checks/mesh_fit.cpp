// SPDX-License-Identifier: Apache-2.0

#include "checks/mesh_fit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <tex/mesh.h>

#include "checks/mesh_seams.h"
#include "checks/seam_evidence.h"
#include "checks/tangent_rules.h"
#include "checks/thresholds.h"

namespace tex::inline v1 {
namespace {

constexpr double kConfident = 0.99;

constexpr double kOtherLengthShare = 0.05;  // of the texels: then a z that the engine rebuilds is another

// Whether two decoders make the same of the map: the same vectors, from the same z.
class SameDecoding {
public:
    explicit SameDecoding(const CheckContext& context)
        : z_counts_(context.stored.has_z() && context.counts.share(Property::off_length) > kOtherLengthShare) {}

    bool operator()(Decoder a, Decoder b) const {
        return same_vectors(a, b) && (!z_counts_ || rebuilds_z(a) == rebuilds_z(b));
    }

private:
    bool z_counts_;
};

// A way of decoding, and what the seams are like then.
struct Candidate {
    SeamSpace space;
    TangentSource tangents = TangentSource::file;
    std::vector<Vector3> gaps;
};

// The other ways with the same direction of green: each kind of decoder with each kind of tangents.
class Candidates {
public:
    Candidates(const CheckContext& context, const SeamSamples& samples)
        : subject_(context), samples_(samples), same_(context) {}

    Result<void> make() {
        for (const TangentMethod method : {TangentMethod::mikktspace, TangentMethod::meshopt}) {
            auto tangents = make_tangents(selected().part, method, 0, subject_.execution);
            if (!tangents) return tangents.error();
            (method == TangentMethod::meshopt ? meshopt_ : mikktspace_) = std::move(*tangents);
        }
        return {};
    }

    [[nodiscard]] Candidate given(bool y_up) const {
        return with(subject_.options.mesh->decoder, selected().tangents, selected().source, y_up);
    }

    // The one that fits surely better than all that were tried before, or `base`.
    [[nodiscard]] Candidate best(Candidate base) const {
        Candidate best = std::move(base);
        const bool y_up = best.space.y_up;
        const Decoder own = best.space.decoder;
        const TangentSource source = selected().source;
        for (const Decoder kind : {Decoder::gltf, Decoder::substance_vertex, Decoder::three, Decoder::godot}) {
            const Decoder decoder = same_(kind, own) ? own : kind;
            try_one(best, with(decoder, selected().tangents, source, y_up));
            if (source != TangentSource::mikktspace)
                try_one(best, with(decoder, mikktspace_, TangentSource::mikktspace, y_up));
            if (source != TangentSource::meshopt) try_one(best, with(decoder, meshopt_, TangentSource::meshopt, y_up));
        }
        return best;
    }

private:
    [[nodiscard]] const SelectedPart& selected() const { return subject_.options.mesh->selected; }
    [[nodiscard]] Candidate with(Decoder decoder, const std::vector<Float4>& tangents, TangentSource source,
                                 bool y_up) const {
        Candidate candidate{{decoder, &tangents, y_up}, source, {}};
        candidate.gaps = samples_.gaps(candidate.space);
        return candidate;
    }
    void try_one(Candidate& best, Candidate other) const {
        if (compare_gaps(samples_, best.gaps, other.gaps).confidence >= kConfident) best = std::move(other);
    }

    const CheckContext& subject_;
    const SeamSamples& samples_;
    SameDecoding same_;
    std::vector<Float4> mikktspace_, meshopt_;
};

// The engines that decode as `decoder` does: "godot, substance-vertex".
std::string engines_like(Decoder decoder, const SameDecoding& same) {
    std::string names;
    for (const auto& row : kDecoderNames) {
        if (same(row.value, decoder)) names.append(names.empty() ? "" : ", ").append(row.name);
    }
    return names;
}

// What the candidate is, as far as it differs from what is given.
std::string difference_of(const Candidate& candidate, const Candidate& given, const SameDecoding& same) {
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
    if (candidate.space.y_up != given.space.y_up) {
        add("green points " + direction(candidate.space.y_up ? YAxis::up : YAxis::down) +
            ", or w of the tangents is flipped");
    }
    if (!same(candidate.space.decoder, given.space.decoder))
        add("the decoder is one of " + engines_like(candidate.space.decoder, same));
    if (candidate.tangents != given.tangents)
        add("the tangents are those of " + std::string(name_of(kTangentSourceNames, candidate.tangents)));
    return text;
}

std::string figures(const SeamEvidence& evidence) {
    return "mean " + decimal(evidence.mean, 2) + ", p99 " + decimal(evidence.p99, 2) + ", mean of the worst edge " +
           decimal(evidence.worst, 2) + " degrees";
}

// Green that points the other way than it should and w of the other sign cancel. If there are seams, they must meet
// better as they are than with one of the two put right.
void check_cancelled(const CheckContext& context, const SeamEvidence* given, const SeamEvidence* otherwise,
                     Findings& findings) {
    constexpr double kNearlyAll = 0.95, kClearly = 0.8, kConfidence = 0.95;
    const Finding* const signs = findings.find("N706");
    if (signs == nullptr || signs->figure < kNearlyAll) return;
    const double correlation = context.y.correlation;
    const bool is_down = correlation < 0.0;
    if (std::abs(correlation) < kLeastCorrelation || context.y.confidence < kConfidence) return;
    if (is_down == (y_on_mesh(context) == YAxis::down)) return;
    std::string message = "green points " + direction(is_down ? YAxis::down : YAxis::up) + " (correlation " +
                          decimal(correlation, 2) + "), and w is the other way in " + percent(signs->figure) +
                          " of the triangles";
    if (given != nullptr && otherwise != nullptr) {
        if (given->mean >= kClearly * otherwise->mean) return;
        message += "; the normals on both sides of seams are " + decimal(given->mean, 1) + " degrees apart, and " +
                   decimal(otherwise->mean, 1) + " if one of the two is put right";
    }
    Finding& finding = findings.add("N707", std::move(message));
    finding.figure = correlation;
    finding.unit = "correlation";
    finding.confidence = context.y.confidence;
}

}  // namespace

YAxis y_on_mesh(const CheckContext& context) {
    if (context.options.require.y) return *context.options.require.y;
    if (context.texture.y_known) return context.texture.y_axis;
    return context.options.mesh->decoder == Decoder::unreal ? YAxis::down : YAxis::up;
}

Result<std::optional<SeamEvidence>> check_mesh_fit(const CheckContext& context, Findings& findings) {
    const SelectedPart& selected = context.options.mesh->selected;
    const std::vector<SeamEdge> edges = find_seams(selected.part);
    if (edges.empty()) {
        check_cancelled(context, nullptr, nullptr, findings);
        return std::optional<SeamEvidence>();
    }
    const SeamSamples samples(selected.part, edges, context.stored, context.options.mesh->scale);
    const Extent extent = context.stored.extent();
    Candidates candidates(context, samples);
    const bool y_up = y_on_mesh(context) == YAxis::up;
    const Candidate given = candidates.given(y_up);
    const SeamEvidence evidence = seam_evidence(samples, given.gaps, extent);
    Candidate flipped = candidates.given(!y_up);
    const SeamEvidence otherwise = seam_evidence(samples, flipped.gaps, extent);
    check_cancelled(context, &evidence, &otherwise, findings);
    if (!findings.wants("N711")) return std::optional(evidence);

    // Only a map whose y clearly meets at the seams can show what it was made for. Most maps do that one way or the
    // other; too few texels on each side, or a map that was never baked on this mesh, do neither.
    const SeamVerdict verdict_y = compare_gaps(samples, given.gaps, flipped.gaps);
    const bool is_flipped = verdict_y.slope >= 1.0 - thresholds::kSeamSlope && verdict_y.confidence >= kConfident;
    const bool is_right = verdict_y.slope <= thresholds::kSeamSlope && verdict_y.confidence <= 1.0 - kConfident;
    if (verdict_y.saved < thresholds::kSeamGap || (!is_flipped && !is_right)) return std::optional(evidence);
    if (const auto made = candidates.make(); !made) return made.error();
    Candidate base = is_flipped ? std::move(flipped) : candidates.given(y_up);
    Candidate best = candidates.best(std::move(base));
    SeamVerdict verdict = compare_gaps(samples, given.gaps, best.gaps);
    if (best.space.decoder == given.space.decoder && best.tangents == given.tangents && !is_flipped)
        return std::optional(evidence);
    if (is_right && (verdict.slope < thresholds::kSeamFit || verdict.saved < thresholds::kSeamGap))
        return std::optional(evidence);
    const SeamEvidence then = seam_evidence(samples, best.gaps, extent);
    Finding& finding =
        findings.add("N711", difference_of(best, given, SameDecoding(context)) + " (" + std::to_string(evidence.edges) +
                                 " seam edges: " + figures(evidence) + "; then " + figures(then) + "; confidence " +
                                 decimal(verdict.confidence, 3) + ")");
    finding.figure = evidence.mean;
    finding.unit = "degrees";
    finding.confidence = std::max(0.5, verdict.confidence);
    finding.regions = {evidence.worst_edge};
    return std::optional(evidence);
}

}  // namespace tex::inline v1
