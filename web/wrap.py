#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
Wraps what HDPTreeMatcher's header marks by CV_WRAP for JavaScript, by the Python package's reader of that header:
    wrap.py hdp_tree_matcher.hpp METHODS DOCUMENTATION
METHODS is included by hdpstereo.cpp; DOCUMENTATION is JSON, the parameters with the header's words for the page.
'''

import json
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'python'))
from wrap import DOXYGEN_WORDS, OUTPUTS, SCALARS, Header, in_words  # noqa: E402


def plain(text):
    '''Sentences without markup'''
    text = re.sub(r'HDPTreeMatcher::', '', text)
    text = re.sub(r' ?@cite \w+', '', text)
    return ' '.join(in_words(text, DOXYGEN_WORDS).split())


def method(result, name, arguments):
    '''The binding of a method'''
    inputs = [a for a in arguments if a[0] in SCALARS]
    outputs = [a for a in arguments if a[0] in OUTPUTS]
    if result not in SCALARS and result != 'void' or len(inputs) + len(outputs) < len(arguments):
        sys.exit('wrap.py cannot wrap %s: wrap it by hand' % name)
    lines = ['.function("%s", emscripten::optional_override([](HDPTreeMatcher& self%s) {' %
             (name, ''.join(', %s %s' % a for a in inputs))]
    if result != 'void':
        lines.append('    %s result = 0;' % result)
    lines += ['    %s %s;' % (OUTPUTS[kind][0], argument) for kind, argument in outputs]
    lines.append('    run([&] { %sself.%s(%s); });' %
                 ('result = ' if result != 'void' else '', name, ', '.join(argument for _, argument in arguments)))
    values = ['result'] * (result != 'void') + [argument for _, argument in outputs]
    if not outputs and values:
        lines.append('    return result;')
    elif len(values) == 1:
        lines.append('    return toJavaScript(%s);' % values[0])
    elif values:
        lines.append('    val values = val::object();')
        lines += ['    values.set("%s", toJavaScript(%s));' % (value, value) for value in values]
        lines.append('    return values;')
    return '\n'.join(lines) + '\n}))\n'


def parameters(header):
    '''Name, kind, and what the header says of each parameter with a setter of one number'''
    for result, name, arguments, documentation in header.methods():
        if not name.startswith('set') or len(arguments) != 1 or arguments[0][0] not in SCALARS:
            continue
        kind, argument = arguments[0]
        brief = re.search(r'@brief (.*?[.])(?=\s|$)', documentation, re.S)
        text = re.sub(r'@brief ', '', documentation)
        text = re.sub(r'@param \w+ ', '', text)
        bounds = re.search(r'(\d+)\.\.(\d+)', documentation)
        yield {
            'name': name[3].lower() + name[4:] if not re.match('P[12]', name[3:]) else name[3:],
            'method': name[3:],
            'kind': kind,
            'brief': plain(brief[1] if brief else re.match(r'.*?[.;:](?=\s|$)', documentation, re.S)[0]),
            'text': plain(text),
            'bounds': [int(bounds[1]), int(bounds[2])] if bounds else None,
        }


def enumerations(header):
    '''Values by the name of their enumeration, each with its words'''
    for match in re.finditer(r'enum (\w+)\s*\{(.*?)\};', header.body, re.S):
        yield match[1], [{'name': name, 'value': int(value), 'text': plain(text)}
                         for name, value, text in re.findall(r'(\w+) = (-?\d+),?\s*//!< ([^\n]*)', match[2])]


def main():
    header_file, methods_file, documentation_file = sys.argv[1:]
    with open(header_file, encoding='utf-8') as f:
        header = Header(f.read())
    with open(methods_file, 'w', encoding='utf-8') as f:
        f.write('// Made by wrap.py\n#ifdef METHODS\n')
        for result, name, arguments, _ in header.methods():
            f.write(method(result, name, arguments))
        f.write('#else\n')
        for _, _, values in header.enumerations():
            f.write(''.join('emscripten::constant("%s", %s);\n' % value for value in values))
        f.write('#endif\n')
    with open(documentation_file, 'w', encoding='utf-8') as f:
        json.dump({'parameters': list(parameters(header)), 'enumerations': dict(enumerations(header))}, f, indent=1)


if __name__ == '__main__':
    main()
