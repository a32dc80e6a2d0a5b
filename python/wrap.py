#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
Wraps what HDPTreeMatcher's header marks by CV_WRAP and CV_PROP, all but what is wrapped by hand:
    wrap.py hdp_tree_matcher.hpp __init__.pyi.in METHODS STUB
METHODS is included by matcher.cpp; STUB is __init__.pyi.in with the same methods, fields and enumerations. A
declaration that this program does not know how to wrap is an error.
'''

import re
import sys

BY_HAND = {'create', 'createLike', 'setTreeStrategy', 'getTreeStrategy', 'setParams', 'getParams', 'getFindings',
           'setPairModel', 'getPairModel'}
FIELDS_BY_HAND = {'treeStrategy': 'TreeStrategy', 'predictionModel': 'Optional[DisparityPredictionModel]'}
# cv::StereoMatcher's, which that header documents, but does not declare
INHERITED = ('minDisparity', 'numDisparities', 'blockSize', 'speckleWindowSize', 'speckleRange', 'disp12MaxDiff')

SCALARS = {'int': 'int', 'double': 'float', 'bool': 'bool'}  # and their names in Python
INPUTS = {'InputArray': 'Optional[npt.NDArray[Any]]'}
NUMBERS = {'sigma'}  # arrays that may be a number
OUTPUTS = {
    'OutputArray': ('cv::Mat', 'Optional[npt.NDArray[Any]]'),
    'CV_OUT std::vector<double>&': ('std::vector<double>', 'npt.NDArray[np.float64]'),
    'CV_OUT std::vector<int>&': ('std::vector<int>', 'npt.NDArray[np.intc]'),
    'CV_OUT std::vector<String>&': ('std::vector<cv::String>', 'List[str]'),
}

DOXYGEN_WORDS = (  # to plain text
    (r'[^.]*cv::noArray\(\)[^.]*\.', ''),
    (r'(?<=[.] )@ref tutorial_\w+', 'The tutorial'),
    (r'@ref tutorial_\w+', 'the tutorial'),
    (r' @cite (\w+)', r' [\1]'),
    (r'\\f[\[\]$]', ''),
    (r'\\ldots', '...'),
    (r'\\(bar|overline) ?', 'mean '),
    (r'\\(\w+) ?\{(.*?)\}', r'\1(\2)'),
    (r'\\([a-zA-Z]+)', r'\1'),
    (r'[{}]', ''),
)

WORDS = DOXYGEN_WORDS + (  # and from C++ to Python
    (r'\b(HDPTreeMatcher|StereoMatcher|Params|Findings|PairModel)::', r'\1.'),
    (r'\bDisparityPredictionModel::', 'DisparityPredictionModel.'),
    (r'cv::Mat_<float>', 'a numpy array of float32'),
    (r'cv::Exception', 'ValueError'),
    (r'cv::', 'cv2.'),
    (r'CV_8UC1', 'uint8'),
    (r'\bBoth empty\b', 'Both None'),
    (r'is\s+empty, it limits', 'is None, it limits'),
    (r'CV_16SC1', 'int16'),
    (r'CV_32SC1', 'int32'),
    (r'CV_16UC2', 'uint16 in two channels'),
    (r'CV_32FC1', 'float32'),
    (r'\btrue\b', 'True'),
    (r'\bfalse\b', 'False'),
)


def in_words(text, words):
    for pattern, replacement in words:
        text = re.sub(pattern, replacement, text, flags=re.S)
    return '\n'.join(line.strip() for line in text.strip().splitlines())


def in_python_words(text):
    return in_words(text, WORDS)


class Header:
    def __init__(self, text):
        documentation, body = text.split('class CV_EXPORTS_W HDPTreeMatcher')
        self.documentation = documentation[documentation.rindex('/**'):]
        struct = re.compile(r'struct CV_EXPORTS_W_SIMPLE (\w+)\s*\{(.*?)\n    \};', re.S)
        self.structs = dict(struct.findall(body))
        self.body = struct.sub('', body)

    def fields(self, struct):
        '''Type, name and documentation of the fields of a struct'''
        for match in re.finditer(r'(?:/\*\*((?:(?!\*/).)*)\*/|//! ([^\n]*))\s*CV_PROP(?:_RW)? ([^;]*?) (\w+);',
                                 self.structs[struct], re.S):
            yield match[3], match[4], match[1] or match[2]

    def enumerations(self):
        '''Name, documentation, and the values by name'''
        for match in re.finditer(r'//! ([^\n]*)\n\s*enum (\w+)\s*\{(.*?)\};', self.body, re.S):
            values = re.findall(r'(\w+) = (-?\d+)', match[3])
            yield match[2], in_python_words(match[1]), values

    def inherited(self):
        '''Setters of cv::StereoMatcher with what the list in the documentation of the class says'''
        for name in INHERITED:
            item = re.search(r'^- (?:\w+, )?%s(?:, \w+)?: (.*?)(?=\n-|\n\n)' % name, self.documentation, re.M | re.S)
            yield 'int', name[0].upper() + name[1:], name, item[1]

    def methods(self):
        '''Result, name, arguments as (type, name), and documentation of what is wrapped'''
        for kind, name, argument, text in self.inherited():
            yield 'void', 'set' + name, [(kind, argument)], text[0].upper() + text[1:]
            yield kind, 'get' + name, [], '@copybrief set%s' % name
        for match in re.finditer(r'(?:/\*\*((?:(?!\*/).)*)\*/\s*)?CV_WRAP ([^(]*?)(\w+)\(([^)]*)\)', self.body, re.S):
            documentation, result, name, arguments = match.groups()
            if name not in BY_HAND:
                arguments = [re.fullmatch(r'(.*?) ?(\w+)', ' '.join(a.split())).groups()
                             for a in arguments.split(',') if a.strip()]
                yield result.replace('virtual', '').strip(), name, arguments, documentation


class Field:
    def __init__(self, header, kind, name, documentation):
        self.kind = kind
        self.name = name
        self.documentation = in_python_words(documentation.replace('@brief ', ''))
        self.enumeration = None
        for enumeration, _, _ in header.enumerations():
            if kind == 'int' and name.lower().endswith(enumeration.lower()):
                self.enumeration = enumeration
        self.is_vector = 'CV_OUT %s&' % kind in OUTPUTS
        if kind not in SCALARS and not self.is_vector and name not in FIELDS_BY_HAND:
            sys.exit('wrap.py cannot wrap the field %s %s: wrap it by hand, and add it to FIELDS_BY_HAND' %
                     (kind, name))

    def cpp(self, struct, is_writable):
        '''The definition of the field'''
        wrapped = struct[0].lower() + struct[1:] + 'Type'
        if self.name in FIELDS_BY_HAND:
            return 'def%s(%s, R"doc(%s)doc");\n' % (self.name[0].upper() + self.name[1:], wrapped,
                                                   self.documentation)
        value = 'toPython(self.%s)' % self.name
        if self.enumeration:
            value = 'enumerator("%s", self.%s)' % (self.enumeration, self.name)
        get = '[](const HDPTreeMatcher::%s& self) { return %s; }' % (struct, value)
        set_ = ' setterOf(%s, "%s", &HDPTreeMatcher::%s::%s),' % (wrapped, self.name, struct, self.name) if is_writable else ''
        return '%s.def_property%s("%s", %s,%s\n    R"doc(%s)doc");\n' % (
            wrapped, '' if is_writable else '_readonly', self.name, get, set_, self.documentation)

    def python_kind(self):
        if self.name in FIELDS_BY_HAND:
            return FIELDS_BY_HAND[self.name]
        return OUTPUTS['CV_OUT %s&' % self.kind][1] if self.is_vector else SCALARS[self.kind]

    def stub(self, is_writable):
        '''The declaration for type checkers'''
        kind = 'HDPTreeMatcher.' + self.enumeration if self.enumeration else self.python_kind()
        lines = '@property\ndef %s(self) -> %s: ...\n' % (self.name, kind)
        if is_writable:
            lines += '@%s.setter\ndef %s(self, value: %s) -> None: ...\n' % (self.name, self.name, self.python_kind())
        return re.sub('^', '        ', lines, flags=re.M).rstrip(' ')


class Method:
    def __init__(self, header, result, name, arguments, documentation, briefs):
        self.name = name
        self.result = result
        self.inputs = [a for a in arguments if a[0] in SCALARS or a[0] in INPUTS]
        self.arrays = [name for kind, name in arguments if kind in INPUTS]
        self.outputs = [a for a in arguments if a[0] in OUTPUTS]
        self.enumeration = None
        for enumeration, _, _ in header.enumerations():
            if name.startswith('get') and result == 'int' and name.endswith(enumeration):
                self.enumeration = enumeration
        if result not in SCALARS and result != 'void' or len(self.inputs) + len(self.outputs) < len(arguments) or \
                not documentation:
            sys.exit('wrap.py cannot wrap %s %s(%s): wrap it by hand, and add it to BY_HAND' %
                     (result, name, ', '.join(' '.join(a) for a in arguments)))
        self.arguments = arguments
        self.documentation = self.document(documentation, briefs)

    def document(self, text, briefs):
        copied = re.search(r'@copybrief (\w+)', text)
        if copied:
            return '%s\n\nSee %s().' % (briefs[copied[1]], copied[1])
        text = text.replace('@brief ', '')
        text = re.sub(r'@return ', 'Returns: ', text)
        text = re.sub(r'@throws ', 'Raises ', text)
        for kind, name in self.arguments:
            what = 'Returns ' if (kind, name) in self.outputs else ''
            text = re.sub(r'@param %s (Receives )?' % name, '\n%s%s: ' % (what, name), text)
        text = in_python_words(text)
        if self.outputs or self.arrays:
            text = text.replace('Empty', 'None')
        briefs[self.name] = re.match(r'.*?[.](?=\s|$)', text, re.S)[0]
        return text

    def cpp(self):
        '''The definition of the method'''
        results = ['toPython(result)'] if self.result != 'void' else []
        results += [('toPython(%s)' if kind == 'OutputArray' else 'listToPython(%s)') % name
                    for kind, name in self.outputs]
        lines = ['matcher.def("%s",' % self.name,
                 '    [](Matcher& self%s) {' % ''.join(', const py::object& %sArray' % name if kind in INPUTS else
                                                       ', %s %s' % (kind, name) for kind, name in self.inputs)]
        if self.arrays:
            lines.append('        std::vector<py::array> kept;')
        lines += ['        const cv::Mat %s = toInput(%sArray, "%s", kept);' % (name, name, name)
                  for name in self.arrays]
        if self.result != 'void':
            lines.append('        %s result;' % self.result)
        lines += ['        %s %s;' % (OUTPUTS[kind][0], name) for kind, name in self.outputs]
        lines.append('        self.run([&](HDPTreeMatcher& m) { %sm.%s(%s); });' %
                     ('result = ' if self.result != 'void' else '', self.name, ', '.join(n for _, n in self.arguments)))
        if self.enumeration:
            lines.append('        return enumerator("%s", result);' % self.enumeration)
        elif len(results) == 1:
            lines.append('        return %s;' % results[0])
        elif results:
            lines.append('        return py::make_tuple(%s);' % ', '.join(results))
        lines.append('    },%s' % ''.join(' py::arg("%s").noconvert(%d).none(%d),' % (name, kind == 'int', kind not in SCALARS)
                                          for kind, name in self.inputs))  # ints: see setterOf()
        lines.append('    R"doc(%s)doc");' % self.documentation)
        return '\n'.join(lines) + '\n'

    def stub(self):
        '''The declaration for type checkers'''
        kinds = [self.enumeration or SCALARS[self.result]] if self.result != 'void' else []
        kinds += [OUTPUTS[kind][1] if kind == 'OutputArray' else 'Optional[%s]' % OUTPUTS[kind][1]
                  for kind, _ in self.outputs]
        result = 'None' if not kinds else kinds[0] if len(kinds) == 1 else 'Tuple[%s]' % ', '.join(kinds)
        arguments = ''.join(', %s: %s' % (name, 'Union[float, npt.NDArray[Any], None]' if name in NUMBERS else
                                          SCALARS.get(kind) or INPUTS[kind]) for kind, name in self.inputs)
        return '    def %s(self%s) -> %s: ...\n' % (self.name, arguments, result)


def main():
    header_file, template_file, methods_file, stub_file = sys.argv[1:]
    with open(header_file, encoding='utf-8') as f:
        header = Header(f.read())
    briefs = {}
    methods = [Method(header, *declaration, briefs) for declaration in header.methods()]

    params, findings = ([Field(header, *field) for field in header.fields(struct)] for struct in ('Params', 'Findings'))

    with open(methods_file, 'w', encoding='utf-8') as f:
        f.write('// Made by wrap.py\n')
        for name, documentation, values in header.enumerations():
            f.write('addEnumeration(matcher, "%s", R"doc(%s)doc", { %s });\n' %
                    (name, documentation, ', '.join('{ "%s", %s }' % value for value in values)))
        for method in methods:
            f.write(method.cpp())
        for field in params:
            f.write(field.cpp('Params', True))
        for field in findings:
            f.write(field.cpp('Findings', False))
        for name, fields in ('paramsType', params), ('findingsType', findings):
            f.write('addRepr(%s, { %s });\n' % (name, ', '.join('"%s"' % field.name for field in fields)))

    stub = ''
    for name, _, values in header.enumerations():
        stub += '    class %s(enum.IntEnum):\n' % name
        stub += ''.join('        %s = %s\n' % value for value in values)
        stub += ''.join('    %s: ClassVar[%s]\n' % (value, name) for value, _ in values) + '\n'
    stub += '    class Params:\n        def __init__(\n            self, preset: Union[int, str] = ..., *,\n'
    stub += ',\n'.join('            %s: %s = ...' % (field.name, field.python_kind()) for field in params)
    stub += ',\n            **fields: Any'  # the same in snake case
    stub += '\n        ) -> None: ...\n' + ''.join(field.stub(True) for field in params) + '\n'
    stub += '    class Findings:\n' + ''.join(field.stub(False) for field in findings) + '\n'
    stub += ''.join(method.stub() for method in methods)
    with open(template_file, encoding='utf-8') as f:
        template = f.read()
    with open(stub_file, 'w', encoding='utf-8') as f:
        f.write(template.replace('    # @METHODS@\n', stub))


if __name__ == '__main__':
    main()
