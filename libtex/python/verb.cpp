// SPDX-License-Identifier: Apache-2.0
#include "verb.h"

#include <algorithm>

#include <fmt/format.h>

#include "docs.h"

namespace tex::python {
namespace {

std::string& stubs() {
    static std::string text;
    return text;
}

std::string listed(const std::vector<Parameter>& parameters, bool typed) {
    std::string text;
    for (const Parameter& parameter : parameters) {
        text += text.empty() ? parameter.name : ", " + parameter.name;
        if (typed) text += ": " + parameter.type;
        if (!parameter.preset.empty()) text += (typed ? " = " : "=") + parameter.preset;
    }
    return text;
}

std::string signature_of(const std::vector<Parameter>& positional, const std::vector<Parameter>& keywords, bool typed) {
    std::string text = listed(positional, typed);
    if (!keywords.empty()) text += (text.empty() ? "*, " : ", *, ") + listed(keywords, typed);
    return "(" + text + ")";
}

// Text in lines of up to 100 columns.
std::string wrapped(std::string_view text) {
    std::string lines;
    std::size_t column = 0;
    while (!text.empty()) {
        const std::string_view word = text.substr(0, text.find(' '));
        if (column > 0 && column + 1 + word.size() > 100) {
            lines += '\n';
            column = 0;
        } else if (column > 0) {
            lines += ' ';
            ++column;
        }
        lines += word;
        column += word.size();
        text.remove_prefix(std::min(text.size(), word.size() + 1));
    }
    return lines;
}

}  // namespace

void Reader::finish(const std::string& function) const {
    if (keywords_.empty()) return;
    const std::string name = py::str((*keywords_.begin()).first);
    throw py::type_error(
        fmt::format("{} got an unexpected argument '{}'{}", function, name, did_you_mean(name, names_)));
}

py::object Reader::take(const char* name) { return keywords_.attr("pop")(name); }

Call::Call(const char* function, const std::vector<Parameter>& parameters, const py::args& given,
           const py::dict& keywords, std::size_t positional)
    : parameters_(parameters) {
    if (given.size() > positional) {
        throw py::type_error(fmt::format("{}() takes {} positional arguments, got {}; options are given by name",
                                         function, positional, given.size()));
    }
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        const Parameter& parameter = parameters[k];
        const bool named = keywords.contains(parameter.name);
        if (k < given.size()) {
            if (named) throw py::type_error(fmt::format("{}() got two values for '{}'", function, parameter.name));
            values_.push_back(given[k]);
        } else if (named) {
            values_.push_back(keywords.attr("pop")(parameter.name));
        } else if (!parameter.preset.empty()) {
            values_.push_back(py::none());
        } else {
            throw py::type_error(fmt::format("{}() needs the argument '{}'", function, parameter.name));
        }
    }
}

py::object Call::operator[](std::string_view name) const {
    for (std::size_t k = 0; k < parameters_.size(); ++k) {
        if (parameters_[k].name == name) return values_[k];
    }
    throw std::logic_error(fmt::format("no parameter {}", name));
}

std::string Lister::define_dict(const std::type_info& type, const std::vector<Parameter>& fields) {
    std::string name = type.name();
    py::detail::clean_type_id(name);
    name = "_" + name.substr(name.rfind(':') + 1);
    const std::string head = "class " + name + "(TypedDict, total=False):\n";
    if (stubs().find(head) != std::string::npos) return name;
    std::string text = head;
    for (const Parameter& field : fields) text += fmt::format("    {}: {}\n", field.name, field.type);
    stubs() = text + "\n" + stubs();
    return name;
}

std::string Module::signature(const std::string& first, const std::vector<Parameter>& positional,
                              const std::vector<Parameter>& keywords) {
    return "(" + first + ", " + signature_of(positional, keywords, true).substr(1);
}

void Module::stub(const std::string& text) {
    stubs() += text + "\n";
    module_.attr("_stubs") = stubs();
}

std::string Module::describe(const char* name, const std::vector<Parameter>& positional,
                             const std::vector<Parameter>& keywords, const char* returns, const std::string& notes) {
    if (overloads_.empty())
        stubs() += fmt::format("def {}{} -> {}: ...\n", name, signature_of(positional, keywords, true), returns);
    for (const auto& [given, returned] : overloads_) {
        std::vector<Parameter> typed = positional;
        typed.front().type = given;
        stubs() += fmt::format("@overload\ndef {}{} -> {}: ...\n", name, signature_of(typed, keywords, true), returned);
    }
    std::string doc = fmt::format("{}{}\n--\n\n{}", name, signature_of(positional, keywords, false), wrapped(notes));
    if (const HeaderComment* const comment = header_comment(name))
        doc += fmt::format("{}From tex/{}:\n\n{}", !notes.empty() ? "\n\n" : "", comment->header, comment->text);
    return doc;
}

}  // namespace tex::python
