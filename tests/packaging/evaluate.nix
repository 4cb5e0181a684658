# SPDX-License-Identifier: Apache-2.0
# Evaluates the expression of libtex with names in the place of packages: { file } -> what it declares.
{ file }:

let
  package = import file;
  names = builtins.attrNames (builtins.functionArgs package);
  lib = {
    cleanSource = source: source;
    cleanSourceWith = { src, filter }: {
      folder = toString src;
      kept = builtins.filter (name: filter "/clone/${name}" "directory") [ "build" "libtex" "tools" ];
    };
    licenses.asl20 = "Apache-2.0";
    platforms.linux = [ "linux" ];
  };
in
package (
  builtins.listToAttrs (map (name: { inherit name; value = name; }) names)
  // { inherit lib; stdenv.mkDerivation = declared: declared; }
)
