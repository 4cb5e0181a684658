# SPDX-License-Identifier: Apache-2.0
"""The module beside the headers: every verb, its defaults, its words, its docstring and its stub."""

import ast
import inspect
import re
import sys
from pathlib import Path

import numpy as np
import pytest

import tex
from conftest import SOURCE

HEADERS = SOURCE / "libtex/include/tex"
sys.path.insert(0, str(SOURCE / "libtex/python"))
from docstrings import DECLARATION, SENTENCES, comments, sentence_pattern  # noqa: E402

NOT_BOUND = {
    "add_requirement": "the argument `require` of check()",
    "allocate_rows": "memory of planes, which arrays keep",
    "apply_steps": "run('build-normals', ...) runs steps without files in between",
    "can_optimise": "pack() ignores the limits of other encodings",
    "check_map": "check_model() checks all of them",
    "check_part": "MeshPart() checks, and parts cannot change",
    "check_raw": "read_image(path, raw=...) checks its layout",
    "decode_blocks": "decode() decodes levels",
    "find_by_name": "words are the names",
    "follows_normals": "a question about one word: is it 'roughness' or 'gloss'",
    "is_model": "read_model() says if a file is none",
    "latitude_of": "HeightField.ground, which bake() applies",
    "least_response_of": "integrate() takes it by default",
    "map_name": "the field `name` of a map of read_model()",
    "maps_of": "a filter of a list",
    "model_files": "run('pack-normals', ..., '--json') says what it wrote",
    "name_of": "words are the names",
    "needs_mesh": "preview() says that there is no mesh",
    "padded_stride": "memory of planes, which arrays keep",
    "put_others": "NormalMap(n, alpha=...), and the argument `others` of pack_file()",
    "read_map": "read_texture() and decode_file() read the image of a map of read_model()",
    "read_model_maps": "read_model() reads the same, with the mesh",
    "rebuilds_z": "to_object_space() and preview() ask it",
    "reconstruct_z": "a formula for one texel, for numpy: sqrt(1 - clip(x * x + y * y, 0, 1))",
    "reconstruct_z_approximate": "the same, for comparison",
    "repair_class": "rule_repairs() has the class of every rule",
    "repair_of": "repair() says it of each fault that is left",
    "text_of": "the field `text` of the steps of repair()",
    "remove_unfinished_files": "for handlers of signals, which Python calls later",
    "selection_of": "select_part(material=..., uv_set=...)",
    "share_maps": "run('blend-normals', ...) shares details between many bases",
    "share_trees": "parts are copied for each call of transfer()",
    "strength_on_ground": "HeightField.ground, which bake() applies",
    "stretch_heights": "for numpy: (heights - low) / (high - low)",
    "texel_size": "HeightField.ground, which bake() applies",
    "to_string": "layouts are words",
    "validate": "check() validates its arguments",
    "with_moved_uvs": "select_part() moves UVs as materials do",
    "write_model": "run('pack-normals', 'scene.glb', '-o', 'fixed.glb') writes models",
}


def cplusplus_headers():
    """All but tex_c.h, which repeats verbs for C."""
    return [header for header in HEADERS.glob("*.h") if header.name != "tex_c.h"]


def declared():
    names = set()
    for header in cplusplus_headers():
        for line in header.read_text(encoding="utf-8").splitlines():
            found = DECLARATION.match(line)
            if found:
                names.add(found.group(1))
    return names


def test_every_function_of_the_headers_is_bound_or_listed():
    names = declared()
    assert len(names) > 60
    bound = {name for name in names if hasattr(tex, name)}
    assert names - bound == set(NOT_BOUND)
    verbs = {name for name in tex.__all__ if inspect.isbuiltin(getattr(tex, name))}
    # read_texture() of bytes: in Python, bytes can be a path.
    assert verbs - names == {"decode_file"}, "bound, but in no header"


def members():
    """The data members of every structure of the headers, by its name."""
    found = {}
    for header in cplusplus_headers():
        text = re.sub(r"//.*", "", header.read_text(encoding="utf-8"))
        for name, body in re.findall(r"^(?:struct|class)(?: TEX_API)? (\w+)[^;{]*\{\n(.*?)^\};", text, re.M | re.S):
            for inner in (r"\{[^{}]*\}", r"<[^<>]*>", r" = [^,;]*"):
                while re.search(inner, body):
                    body = re.sub(inner, "", body)
            data = re.findall(r"^    (?!static |using |friend )[\w: ]+\*? ((?:\w+(?:, )?)+)(?:\[\w+\])*;", body, re.M)
            found[name] = {member for several in data for member in several.split(", ")}
    return found


def test_pickles_hold_every_member():
    left_out = {"CheckReport": {"error"}}  # verbs raise it
    texts = (SOURCE / "libtex/python/pickling.h").read_text(encoding="utf-8")
    pickled = re.findall(r"void each_part\((\w+)& o, F& f\) \{\n(.*?)^\}", texts, re.M | re.S)
    assert len(pickled) > 10
    for name, body in pickled:
        assert set(re.findall(r"\bo\.(\w+)", body)) == members()[name] - left_out.get(name, set()), name


def verbs():
    return sorted(name for name in tex.__all__ if inspect.isbuiltin(getattr(tex, name)))


@pytest.mark.parametrize("name", verbs())
def test_docstrings_are_the_comments_of_the_headers(name):
    doc = inspect.getdoc(getattr(tex, name))
    assert doc
    texts = [(header.name, text) for header in cplusplus_headers() for function, text in comments(header)
             if function == name and text]
    for header, text in texts:
        if header == doc.partition("From tex/")[2].partition(":")[0]:
            assert inspect.cleandoc(text) in doc
    assert not texts or "From tex/" in doc


def fields(header, structure):
    """The defaults of a structure's fields, as the header writes them."""
    text = (HEADERS / header).read_text(encoding="utf-8")
    body = re.search(rf"^struct {structure} {{\n(.*?)^}};", text, re.DOTALL | re.MULTILINE).group(1)
    found = {}
    for line in body.splitlines():
        for name, value in re.findall(r"(\w+) = ([^,;{}]+)[,;]", line.split("//")[0]):
            found[name] = value
    return found


STRUCTURES = [
    ("bake", "bake.h", "BakeOptions"),
    ("height_field", "height.h", "HeightOptions"),
    ("build_mip_chain", "mip.h", "MipOptions"),
    ("curvature", "surface.h", "CurvatureOptions"),
    ("occlusion", "surface.h", "OcclusionOptions"),
    ("integrate", "surface.h", "IntegrateOptions"),
    ("pack", "pack.h", "PackOptions"),
    ("unpack", "pack.h", "UnpackOptions"),
    ("blend", "blend.h", "BlendOptions"),
    ("preview", "preview.h", "PreviewOptions"),
    ("write_texture", "file.h", "WriteOptions"),
    ("read_image", "file.h", "ReadOptions"),
    ("bake", "types.h", "Execution"),
    ("to_object_space", "mesh.h", "ConvertOptions"),
    ("transfer", "transfer.h", "TransferOptions"),
]


def word(value):
    """An enumerator as its word: GradientKernel::central is 'central'."""
    return value.split("::")[1].strip("_").replace("_", "-")


@pytest.mark.parametrize(("verb", "header", "structure"), STRUCTURES, ids=[row[2] for row in STRUCTURES])
def test_defaults_are_those_of_the_headers(verb, header, structure):
    parameters = inspect.signature(getattr(tex, verb)).parameters
    found = fields(header, structure)
    assert found
    for name, value in found.items():
        shown = parameters[re.sub("_[xy]$", "", name) if name not in parameters else name].default
        if "::" in value:
            assert shown == {"automatic": "auto"}.get(word(value), word(value)), name
        elif value in ("true", "false"):
            assert shown is (value == "true"), name
        elif re.fullmatch(r"-?[\d.]+f?", value):
            assert shown == float(value.rstrip("f")), name


def test_words_are_those_of_the_name_tables():
    with pytest.raises(ValueError) as caught:
        tex.bake([[0.0]], kernel="nonsense")
    table = re.search(r"kGradientKernelNames\[\] = {(.*?)};", (HEADERS / "bake.h").read_text(encoding="utf-8"),
                      re.DOTALL).group(1)
    words = re.findall(r'::\w+, "([^"]+)"', table)
    assert len(words) == 7 and str(caught.value).endswith(", ".join(f"'{each}'" for each in words))


def stub():
    return ast.parse((Path(tex.__file__).parent / "__init__.pyi").read_text(encoding="utf-8"))


def test_stubs_have_the_signatures_of_the_module():
    functions = {node.name: node for node in stub().body if isinstance(node, ast.FunctionDef)}
    assert sorted(functions) == verbs()
    for name, node in functions.items():
        signature = inspect.signature(getattr(tex, name))
        positional = [p.name for p in signature.parameters.values() if p.kind is p.POSITIONAL_OR_KEYWORD]
        keywords = [p.name for p in signature.parameters.values() if p.kind is p.KEYWORD_ONLY]
        assert [a.arg for a in node.args.args] == positional
        assert [a.arg for a in node.args.kwonlyargs] == keywords
        presets = [ast.literal_eval(value) for value in node.args.kw_defaults]
        assert presets == [signature.parameters[each].default for each in keywords], name
        assert node.returns is not None and all(a.annotation for a in node.args.args + node.args.kwonlyargs)


def test_stubs_have_the_attributes_of_the_classes():
    classes = {node.name: node for node in stub().body if isinstance(node, ast.ClassDef) and node.name[0] != "_"}
    assert set(classes) == {n for n in tex.__all__ if inspect.isclass(getattr(tex, n)) and getattr(tex, n).__module__ == "tex._tex"}
    for name, node in classes.items():
        members = {each.name for each in node.body if isinstance(each, ast.FunctionDef)}
        real = {n for n in vars(getattr(tex, name)) if not n.startswith("_")}
        assert real <= members and all(hasattr(getattr(tex, name), each) for each in members)


def test_stubs_use_known_names():
    known = {"str", "int", "float", "bool", "bytes", "dict", "list", "tuple", "object", "memoryview", "bytearray",
             "property", "self"}
    tree = stub()
    for node in tree.body:
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            known |= {alias.asname or alias.name for alias in node.names}
        elif isinstance(node, ast.ClassDef):
            known.add(node.name)
        elif isinstance(node, ast.Assign):
            known |= {target.id for target in node.targets}
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}
    assert used - known <= {"__version__"}


def test_nested_options_and_results_have_types():
    text = (Path(tex.__file__).parent / "__init__.pyi").read_text(encoding="utf-8")
    assert re.search(r"^def bake_file\(.* mip: _MipOptions = {}, pack: _PackFields", text, re.MULTILINE)
    dicts = {node.name: node for node in ast.parse(text).body if isinstance(node, ast.ClassDef) and node.name[0] == "_"}
    assert {each.target.id for each in dicts["_MipOptions"].body} == set(
        inspect.signature(tex.build_mip_chain).parameters) - {"base", "threads", "progress"}
    for name in ("scale", "unpack"):
        found = re.findall(rf"^@overload\ndef {name}\((.*)\) -> (.*): \.\.\.$", text, re.MULTILINE)
        assert [returned.startswith("list[") for _, returned in found] == [True, False]


@pytest.mark.parametrize("name", verbs())
def test_docstrings_speak_python(name):
    doc = inspect.getdoc(getattr(tex, name))
    assert not re.search(r"::|\bnull|nullopt|\(asserted\)|\boptions\.\w|\.size\(\)|bad_|out_of_memory", doc)


# Names that docstrings may use although the module has none of them.
OUTSIDE = {"BasisLZ", "FourCC", "NaN", "NormalMaps", "OpenColorIO", "OpenGL", "RxBG", "UnpackScaleNormal",
           "UserWarning", "ValueError", "ViewLayer", "VkFormat", "VkFormats"}


def names_of(text):
    """What looks like a name: calls, constants, types."""
    return set(re.findall(r"\b([a-z_]\w*)\(\)|\b(k[A-Z]\w*)|\b((?:[A-Z][a-z]+){2,}|[A-Z]\w*[a-z][A-Z]\w*)\b", text))


@pytest.mark.parametrize("name", verbs())
def test_docstrings_name_what_the_module_has(name):
    doc = " ".join(inspect.getdoc(getattr(tex, name)).split())
    explained = set(re.findall(r"fields of (\w+)", doc)) & set(members())
    known = set(tex.__all__) | OUTSIDE | explained | set(inspect.signature(getattr(tex, name)).parameters)
    assert {next(filter(None, found)) for found in names_of(doc)} <= known


def test_sentences_that_python_replaces_are_still_in_the_headers():
    texts = {}
    for header in cplusplus_headers():
        for function, text in comments(header):
            texts[function] = texts.get(function, "") + text
    for function, words, instead in SENTENCES:
        assert not re.search(sentence_pattern(words), texts[function]), words
        assert " ".join(instead.split()) in " ".join(texts[function].split()), (function, instead)
        assert " ".join(instead.split()) in " ".join(inspect.getdoc(getattr(tex, function)).split())


FLAT = np.float32([[[0, 0, 1]]])


def test_arguments_are_checked():
    for call, text in (
        (lambda: tex.bake(), "needs the argument 'height'"),
        (lambda: tex.bake([[0.0]], 3), "takes 1 positional"),
        (lambda: tex.bake([[0.0]], height=[[0.0]]), "two values for 'height'"),
        (lambda: tex.bake([[0.0]], kernels="x"), "unexpected argument 'kernels'; did you mean 'kernel'?"),
        (lambda: tex.pack(FLAT, efort="best"), "unexpected argument 'efort'; did you mean 'effort'?"),
        (lambda: tex.pack(FLAT, chian=1), "unexpected argument 'chian'; did you mean 'chain'?"),
        (lambda: tex.pack(FLAT, format="bc5"), "unexpected argument 'format'; did you mean 'encoding'?"),
        (lambda: tex.pack(([FLAT], {}), "bc5"), "chain: expected an array, or a list of levels, got tuple, as read_normals()"),
        (lambda: tex.check(([FLAT], {})), "got tuple, as read_normals() returns it: (chain, info)"),
        (lambda: tex.pack(FLAT, nonsense=1), "unexpected argument 'nonsense'"),
        (lambda: tex.Texture(), "Texture() needs the argument 'format'"),
        (lambda: tex.Texture(3, 4, 5), "format: expected one of the words"),
        (lambda: tex.Texture("bc5-unorm", (4, 4), b"0" * 16), "levels: expected a list of the bytes of each level"),
        (lambda: tex.Texture("bc5-unorm", (4, 4), [], "bc5"), "takes 3 positional arguments, got 4"),
        (lambda: tex.Texture("bc5-unorm", (4, 4), [], swizle=1), "did you mean 'swizzle'?"),
        (lambda: tex.Mesh(3), "parts: expected a list of MeshPart"),
        (lambda: tex.bake([[0.0]], kernel=1), "kernel: expected one of the words"),
        (lambda: tex.bake([[0.0]], gaussian_sigma="1"), "gaussian_sigma: expected a number"),
        (lambda: tex.height_field([[0.0]], invert=1), "invert: expected bool"),
        (lambda: tex.bake_file("a", "b.dds", mip=3), "mip: expected a dict"),
        (lambda: tex.bake_file("a", "b.dds", mip={"filters": 1}), "mip got an unexpected argument 'filters'; did you mean 'filter'?"),
        (lambda: tex.read_image(3), "path: expected str or os.PathLike"),
        (lambda: tex.preview(FLAT, ambient=3), "ambient: expected three numbers"),
    ):
        with pytest.raises(TypeError, match=re.escape(text)):
            call()
    for call, text in (
        (lambda: tex.bake([[0.0]], gaussian_sigma=0), "gaussian_sigma: must be above 0"),
        (lambda: tex.bake([[0.0]], bumpiness=float("nan")), "bumpiness: must be finite"),
        (lambda: tex.bake([[0.0]], wrap=("repeat",)), "wrap: expected a value or a pair"),
        (lambda: tex.bake([[0.0]], threads=1 << 40), "threads: 1099511627776 must be from"),
        (lambda: tex.build_mip_chain(FLAT, fade=(3, 1)), "fade: first must be"),
        (lambda: tex.build_mip_chain(FLAT, levels=-1), "levels: must be 0"),
        (lambda: tex.unpack([[0.0]], swizzle="xyzq"), "swizzle: 'xyzq' must be one of"),
        (lambda: tex.scale(FLAT, 1e9), "scale: must be at most 1e6"),
        (lambda: tex.decode(tex.pack(FLAT), 1), "level: must be from 0 to 0"),
        (lambda: tex.compare(FLAT, np.tile(FLAT, (1, 2, 1))), "b: expected 1 x 1 texels"),
        (lambda: tex.encode_blocks(FLAT, "rgb8"), "encoding: must be one of"),
        (lambda: tex.blend(FLAT, [{}]), "layers[0]: needs 'detail'"),
        (lambda: tex.encode_picture(tex.pack(FLAT)), "picture: must be a picture"),
        (lambda: tex.level_extent((4, 4), 1 << 31), "level: 2147483648 must be from 0 to 2147483647"),
        (lambda: tex.level_extent((4, 4), -1), "level: -1 must be from 0 to 2147483647"),
        (lambda: tex.read_image("a\0b"), "embedded null byte"),
        (lambda: tex.read_image("a", max_texels=-5), "max_texels: must be 1 or more"),
        (lambda: tex.bake_file("a", "b.dds", read={"max_texels": 0}), "max_texels: must be 1 or more"),
        (lambda: tex.preview(FLAT, spin=float("nan")), "spin: must be finite"),
        (lambda: tex.preview(FLAT, camera={"yaw": float("nan")}), "camera: yaw: must be finite"),
        (lambda: tex.strength_from_world((0, 0), 1, 0), "width: must be above 0"),
    ):
        with pytest.raises(ValueError, match=re.escape(text)):
            call()


def test_words_may_be_written_as_others_do():
    assert tex.pack(FLAT, "BC5").format == tex.pack(FLAT, "bc5").format == "bc5-unorm"
    assert tex.Texture("BC5_UNORM", (4, 4), [bytes(16)]).format == "bc5-unorm"
    assert np.array_equal(tex.bake([[0.0, 1.0]], wrap="Clamp"), tex.bake([[0.0, 1.0]], wrap="clamp"))


def test_defaults_work():
    image = tex.Image(np.uint8([[0, 128, 255]]))
    assert np.allclose(tex.to_linear(image)["Y"], tex.to_linear(image, space="sRGB")["Y"])
    assert tex.to_linear(image)["Y"][0, 1] < 0.25
