#!/bin/bash
# Installs what is missing, and makes the reference and the tutorials: build/doc/html/index.html, which need no network to
# show their formulas. Fails if Doxygen has a warning: a public symbol without documentation, a wrong parameter name, a
# reference or a picture that is not there.
# shellcheck source-path=SCRIPTDIR source=common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

install_packages doxygen texlive-binaries libjs-mathjax # texlive-binaries has bibtex, for @cite
for program in doxygen bibtex; do
    command -v "$program" >/dev/null || fail "no documentation without $program"
done

html=$build/doc/html
mathjax=/usr/share/javascript/mathjax
mkdir -p "$html"
if [ -e "$mathjax/MathJax.js" ]; then
    ln -sfn "$mathjax" "$html/mathjax"
    export MATHJAX_RELPATH=mathjax # for doc/Doxyfile
else
    say "No libjs-mathjax: the formulas need a network"
fi

cd "$checkout"
# bibtex alone, without the rest of TeX, does not know where to look.
{ cat doc/Doxyfile && echo "OUTPUT_DIRECTORY = \"$build/doc\""; } | BIBINPUTS=. BSTINPUTS=. doxygen -
say "Done: $html/index.html"
