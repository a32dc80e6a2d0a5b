#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
Wraps what HDPTreeMatcher's header marks by CV_WRAP and CV_PROP for JavaScript, by the Python package's reader of
that header:
    wrap.py hdp_tree_matcher.hpp METHODS DOCUMENTATION
METHODS is included by hdpstereo.cpp; DOCUMENTATION is JSON, the parameters with the header's words for the page.
'''

import json
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'python'))
from wrap import DOXYGEN_WORDS, FIELDS_BY_HAND, INPUTS, OUTPUTS, SCALARS, Header, in_words  # noqa: E402


def plain(text):
    '''Sentences without markup'''
    text = re.sub(r'(HDPTreeMatcher|Params|Findings)::', '', text)
    text = re.sub(r' ?@cite \w+', '', text)
    return ' '.join(in_words(text, DOXYGEN_WORDS).split())


def method(result, name, arguments):
    '''The binding of a method'''
    inputs = [a for a in arguments if a[0] in SCALARS or a[0] in INPUTS]
    outputs = [a for a in arguments if a[0] in OUTPUTS]
    if result not in SCALARS and result != 'void' or len(inputs) + len(outputs) < len(arguments):
        sys.exit('wrap.py cannot wrap %s: wrap it by hand' % name)
    lines = ['.function("%s", emscripten::optional_override([](HDPTreeMatcher& self%s) {' %
             (name, ''.join(', const val& %sImage' % name if kind in INPUTS else ', %s %s' % (kind, name)
                            for kind, name in inputs))]
    if result != 'void':
        lines.append('    %s result = 0;' % result)
    lines += ['    %s %s;' % (OUTPUTS[kind][0], argument) for kind, argument in outputs]
    call = ''.join('const cv::Mat %s = toInput(%sImage, "%s"); ' % (argument, argument, argument)
                   for kind, argument in inputs if kind in INPUTS)
    lines.append('    run([&] { %s%sself.%s(%s); });' %
                 (call, 'result = ' if result != 'void' else '', name,
                  ', '.join(argument for _, argument in arguments)))
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


def structs(header):
    '''The bindings of Params and Findings: objects. A field of Params that is not there stays as it is.'''
    for struct in ('Params', 'Findings'):
        fields = [(kind, name) for kind, name, _ in header.fields(struct) if name not in FIELDS_BY_HAND]
        yield ('.function("get%s", emscripten::optional_override([](HDPTreeMatcher& self) {\n'
               '    const HDPTreeMatcher::%s values = self.get%s();\n'
               '    val object = val::object();\n' % (struct, struct, struct))
        for _, name in fields:
            yield '    object.set("%s", toJavaScript(values.%s));\n' % (name, name)
        yield '    return object;\n}))\n'
    yield ('.function("setParams", emscripten::optional_override([](HDPTreeMatcher& self, const val& object) {\n'
           '    HDPTreeMatcher::Params params = self.getParams();\n')
    for kind, name, _ in header.fields('Params'):
        if name not in FIELDS_BY_HAND:
            yield '    read(object, "%s", params.%s);\n' % (name, name)
    yield '    run([&] { self.setParams(params); });\n}))\n'


def declarations(header):
    '''Kind, name, setter if it is no field of Params, and documentation of each parameter that is a number'''
    fields = [field for field in header.fields('Params') if field[1] not in FIELDS_BY_HAND]
    names = [name for _, name, _ in fields]
    for kind, name, argument, documentation in header.inherited():
        if argument not in names:
            yield kind, argument, name, documentation
    for kind, name, documentation in fields:
        yield kind, name, None, documentation


def parameters(header):
    '''Name, kind, and what the header says of each parameter that is a number'''
    for kind, name, setter, documentation in declarations(header):
        brief = re.search(r'@brief (.*?[.])(?=\s|$)', documentation, re.S)
        text = re.sub(r'@brief ', '', documentation)
        bounds = re.search(r'(\d+)\.\.(\d+)', documentation) if kind == 'int' else None
        yield {
            'name': name,
            'method': setter,
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
        f.write(''.join(structs(header)))
        f.write('#else\n')
        for _, _, values in header.enumerations():
            f.write(''.join('emscripten::constant("%s", %s);\n' % value for value in values))
        f.write('#endif\n')
    with open(documentation_file, 'w', encoding='utf-8') as f:
        json.dump({'parameters': list(parameters(header)), 'enumerations': dict(enumerations(header))}, f, indent=1)


if __name__ == '__main__':
    main()
