# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
Fast non-local stereo matching: disparities of a rectified pair, for numpy arrays.

    import hdpstereo
    matcher = hdpstereo.HDPTreeMatcher.create(num_disparities=128, preset='quality', disp12_max_diff=1)
    disparity = matcher.compute(left, right, as_float=True)  # pixels; NaN where there is none
    confidence = matcher.getConfidence()  # 0 .. 255

StereoRig reads calibrations, rectifies raw pairs, and makes depth of disparities.
'''

import operator

from ._hdpstereo import (CV_16S, CV_32F, DisparityPredictionModel, HDPTreeMatcher, PairModel, RigDrift,
                         StereoCalibration, StereoRig, TreeState, TreeStrategy, __version__,
                         createMinimumSpanningTree, createRandomTree, createSegmentTree, getNumThreads,
                         readStereoCalibration, setNumThreads)

__all__ = ['CV_16S', 'CV_32F', 'DisparityPredictionModel', 'HDPTreeMatcher', 'PairModel', 'RigDrift',
           'StereoCalibration', 'StereoRig', 'TreeState', 'TreeStrategy', 'createMinimumSpanningTree',
           'createRandomTree', 'createSegmentTree', 'getNumThreads', 'readStereoCalibration', 'setNumThreads']

# Parameters by name, and repr(), which has the form of the call that creates the matcher

_construct, _construct_params = HDPTreeMatcher.__init__, HDPTreeMatcher.Params.__init__
_like = HDPTreeMatcher.createLike


def _in_camel_case(name):
    first, *others = name.split('_')
    return first + ''.join(word[:1].upper() + word[1:] for word in others)


def _with_names_in_camel_case(parameters):
    renamed = {_in_camel_case(name): value for name, value in parameters.items()}
    if len(renamed) < len(parameters):
        raise TypeError('a parameter is given twice, in camel case and in snake case: ' + ', '.join(parameters))
    return renamed


def _preset(preset):
    if not isinstance(preset, str):
        return preset
    try:
        return HDPTreeMatcher.Preset['PRESET_' + preset.upper()]
    except KeyError:
        names = ', '.join(repr(known.name[7:].lower()) for known in HDPTreeMatcher.Preset)
        raise ValueError('preset must be one of %s, not %r' % (names, preset)) from None


def _integer(name, value):
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError('%s must be an int, not %r' % (name, value)) from None


def _init_params(self, preset=HDPTreeMatcher.PRESET_FAST, **fields):
    _construct_params(self, _preset(preset), **_with_names_in_camel_case(fields))


class _Default(int):
    '''An argument that was not given'''


def _init(self, minDisparity=_Default(0), numDisparities=_Default(64), preset=HDPTreeMatcher.PRESET_FAST, **parameters):
    parameters = _with_names_in_camel_case(parameters)
    for name, own in ('minDisparity', minDisparity), ('numDisparities', numDisparities):
        if name in parameters and not isinstance(own, _Default):
            raise TypeError('a parameter is given twice: ' + name)
    _construct(self, _integer('minDisparity', parameters.pop('minDisparity', minDisparity)),
               _integer('numDisparities', parameters.pop('numDisparities', numDisparities)), _preset(preset))
    params = self.getParams()
    for name, value in parameters.items():
        setter = getattr(self, 'set' + name[:1].upper() + name[1:], None)
        if not name.startswith('_') and hasattr(params, name):
            setattr(params, name, value)
        elif name != 'params' and setter is not None:
            setter(value)
        else:
            raise TypeError('HDPTreeMatcher has no parameter ' + name)
    self.setParams(params)


def _create(minDisparity=_Default(0), numDisparities=_Default(64), preset=HDPTreeMatcher.PRESET_FAST, **parameters):
    return HDPTreeMatcher(minDisparity, numDisparities, preset, **parameters)


def _create_like(sgbm, preset=HDPTreeMatcher.PRESET_FAST):
    return _like(sgbm, _preset(preset))


def _fields(matcher):
    params = matcher.getParams()
    fields = {name: getattr(params, name) for name in dir(params) if not name.startswith('_')}
    fields['treeStrategy'] = params.treeStrategy.getDefaultName()
    for name in ('speckleWindowSize', 'speckleRange', 'disp12MaxDiff'):
        fields[name] = getattr(matcher, 'get' + name[0].upper() + name[1:])()
    return fields


def _repr(self):
    fields, differences = _fields(self), []
    for preset in HDPTreeMatcher.Preset:
        values = _fields(HDPTreeMatcher(preset=preset))
        differences.append((preset, {name: value for name, value in fields.items() if value != values[name]}))
    preset, others = min(differences, key=lambda difference: len(difference[1]))
    return 'HDPTreeMatcher(minDisparity=%d, numDisparities=%d, preset=%r%s)' % (
        self.getMinDisparity(), self.getNumDisparities(), preset.name[7:].lower(),
        ''.join(', %s=%s' % (name, getattr(value, 'name', value)) for name, value in sorted(others.items())))


_create.__doc__ = _init.__doc__ = '''\
Creates a matcher.

minDisparity: smallest disparity in pixels, of any sign.
numDisparities: number of candidates, >= 0; 0: both are found in each pair, see getFindings().
preset: HDPTreeMatcher.PRESET_FAST, PRESET_ULTRAFAST, PRESET_QUALITY, PRESET_TREE or PRESET_PAPER, or its name: 'fast'.
parameters: all others by name, as Params and the setters have them. Names may be in snake case, too:
    HDPTreeMatcher.create(num_disparities=128, preset='quality', disp12_max_diff=1, fill_occlusions=False)'''

_init_params.__doc__ = '''\
The values of a preset, but for some fields: Params('quality', fill_occlusions=False).

preset: as create() has it.
fields: by name, in snake case, too.'''


def _restored_calibration(fields):
    calibration = StereoCalibration()
    for name, value in fields.items():
        setattr(calibration, name, value)
    return calibration


def _reduce_calibration(self):
    fields = {name: getattr(self, name) for name in dir(self) if not name.startswith('_')}
    return _restored_calibration, ({name: value for name, value in fields.items() if value is not None},)


StereoCalibration.__reduce__ = _reduce_calibration  # for pickle and copy
HDPTreeMatcher.__init__, HDPTreeMatcher.__repr__ = _init, _repr
HDPTreeMatcher.Params.__init__ = _init_params
_create_like.__doc__ = _like.__doc__
HDPTreeMatcher.create, HDPTreeMatcher.createLike = staticmethod(_create), staticmethod(_create_like)
