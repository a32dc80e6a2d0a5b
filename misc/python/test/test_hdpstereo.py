#!/usr/bin/env python
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

'''
cv.stereo.HDPTreeMatcher from Python. Runs among the tests of OpenCV's build, or alone:
    PYTHONPATH=<folder of cv2> python3 test_hdpstereo.py
'''

from __future__ import print_function

import os
import shutil
import tempfile
import threading
import tracemalloc
import unittest

import numpy as np
import cv2 as cv

try:
    from tests_common import NewOpenCVTests as TestCase
except ImportError:  # alone
    TestCase = unittest.TestCase

PRESETS = {name: getattr(cv.stereo, 'HDPTreeMatcher_PRESET_' + name)
           for name in ('PAPER', 'FAST', 'ULTRAFAST', 'QUALITY', 'TREE')}

# Of each parameter, what it is after create(-3, 40, PRESET_PAPER), and another value
PARAMETERS = {
    'MinDisparity': (-3, 5),
    'NumDisparities': (40, 33),
    'BlockSize': (1, 5),
    'SpeckleWindowSize': (0, 100),
    'SpeckleRange': (1, 2),
    'Disp12MaxDiff': (-1, 1),
    'UsePrediction': (True, False),
    'UseMedianPrefilter': (False, True),
    'NumLayers': (3, 2),
    'MaxTopDisparities': (0, 64),
    'MaxRowOffset': (0, 16),
    'UseLightAlignment': (False, True),
    'NoiseThreshold': (0, 2.5),
    'Delta0': (-1, 0.125),
    'Beta': (-1, 0.5),
    'Gamma': (25.5, 12.75),
    'ColorTruncation': (10, 7.5),
    'GradientTruncation': (2, 3.5),
    'ColorWeight': (0.11, 0.25),
    'DisparityMedianSize': (-1, 3),
    'MatchingCost': (cv.stereo.HDPTreeMatcher_COST_COLOR_GRADIENT, cv.stereo.HDPTreeMatcher_COST_CENSUS),
    'DisparityPrior': (cv.stereo.HDPTreeMatcher_PRIOR_SUPPORT_POINTS, cv.stereo.HDPTreeMatcher_PRIOR_UPPER_LAYER),
    'IntervalMargin': (0, 2),
    'UseSubpixel': (False, True),
    'Aggregation': (cv.stereo.HDPTreeMatcher_AGGREGATION_TREES, cv.stereo.HDPTreeMatcher_AGGREGATION_SCANLINES),
    'P1': (16, 7),
    'P2': (65, 60),
    'FinestLayer': (0, 1),
    'TopAggregation': (cv.stereo.HDPTreeMatcher_AGGREGATION_TREES,
                       cv.stereo.HDPTreeMatcher_AGGREGATION_TREE_SCANLINES),
    'ScanlinePasses': (1, 3),
    'FillOcclusions': (False, True),
    'UseNonLocalRefinement': (False, True),
    'UseTemporalPrediction': (False, True),
    'DisparityDepth': (cv.CV_16S, cv.CV_32F),
}


def field(parameter):
    return parameter if parameter in ('P1', 'P2') else parameter[0].lower() + parameter[1:]


def change(matcher, **fields):
    '''Sets fields of a matcher's Params.'''
    params = matcher.getParams()
    for name, value in fields.items():
        setattr(params, name, value)
    matcher.setParams(params)


def get(matcher, parameter):
    if hasattr(matcher, 'get' + parameter):
        return getattr(matcher, 'get' + parameter)()
    return getattr(matcher.getParams(), field(parameter))


def set_(matcher, parameter, value):
    if hasattr(matcher, 'set' + parameter):
        getattr(matcher, 'set' + parameter)(value)
    else:
        change(matcher, **{field(parameter): value})


def parameters(matcher):
    return {name: get(matcher, name) for name in PARAMETERS}


def create_pair(shape=(120, 160), background=4, foreground=11):
    '''A textured square in front of a textured wall: left and right image (BGR), and the left disparities.'''
    rng = np.random.RandomState(7)
    noise = cv.GaussianBlur(rng.randint(0, 256, shape + (3,)).astype(np.float32), (0, 0), 2.0)
    right = cv.normalize(noise, None, 0, 255, cv.NORM_MINMAX).astype(np.uint8)
    truth = np.full(shape, background, np.float32)
    truth[shape[0] // 4:-shape[0] // 4, shape[1] // 3:-shape[1] // 4] = foreground
    y, x = np.mgrid[:shape[0], :shape[1]]
    left = right[y, np.maximum(x - truth.astype(int), 0)]
    truth[x < truth] = 0  # outside of the right image
    return left, right, truth


def read_matcher(filename):
    matcher = cv.stereo.HDPTreeMatcher.create()
    storage = cv.FileStorage(filename, cv.FileStorage_READ)
    matcher.read(storage.getFirstTopLevelNode())
    storage.release()
    return matcher


def read_ply(filename):
    '''The vertices of an ASCII .ply file, an array with a row for each.'''
    with open(filename, 'rb') as f:
        header = f.read().split(b'end_header\n')[0].decode().splitlines()
    count = int([line.split()[2] for line in header if line.startswith('element vertex')][0])
    properties = [line.split()[2] for line in header if line.startswith('property')]
    vertices = np.loadtxt(filename, skiprows=len(header) + 1)
    assert vertices.shape == (count, len(properties))
    return vertices


class hdpstereo_test(TestCase):

    @classmethod
    def setUpClass(cls):
        cls.left, cls.right, cls.truth = create_pair()
        cls.directory = tempfile.mkdtemp()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.directory)

    def path(self, name):
        return os.path.join(self.directory, name)

    def wrong(self, disparity, threshold=1):
        '''Share of the pixels of known truth that are wrong.'''
        known = self.truth > 0
        return np.mean(np.abs(disparity[known] - self.truth[known]) >= threshold)

    def assertSame(self, expected, actual):
        self.assertEqual(expected.dtype, actual.dtype)
        np.testing.assert_array_equal(expected, actual)

    def assertRejected(self, message, function, *args):
        '''cv.error whose err is the message, as that of cv::Exception in C++.'''
        with self.assertRaises(cv.error) as context:
            function(*args)
        self.assertEqual(message, context.exception.err)
        self.assertIn(message, str(context.exception))

    # ---- The class

    def test_is_a_stereo_matcher(self):
        matcher = cv.stereo.HDPTreeMatcher.create()
        self.assertIsInstance(matcher, cv.StereoMatcher)
        self.assertIsInstance(matcher, cv.Algorithm)
        self.assertIsInstance(cv.stereo.HDPTreeMatcher_create(), cv.stereo.HDPTreeMatcher)
        self.assertEqual((0, 64), (matcher.getMinDisparity(), matcher.getNumDisparities()))
        matcher = cv.stereo.HDPTreeMatcher.create(minDisparity=-2, numDisparities=17, preset=PRESETS['QUALITY'])
        self.assertEqual((-2, 17), (matcher.getMinDisparity(), matcher.getNumDisparities()))

    def test_parameters(self):
        matcher = cv.stereo.HDPTreeMatcher.create(-3, 40, PRESETS['PAPER'])
        setters = set(name[3:] for name in dir(matcher)
                      if name.startswith('set') and hasattr(matcher, 'get' + name[3:]))
        self.assertEqual(set(), setters - set(PARAMETERS) - set(['TreeStrategy', 'Params', 'PairModel']),
                         'one is not tested')
        fields = set(name for name in dir(matcher.getParams()) if not name.startswith('_'))
        only_matcher = set(['minDisparity', 'numDisparities', 'speckleWindowSize', 'speckleRange', 'disp12MaxDiff'])
        self.assertEqual(fields, set(field(name) for name in PARAMETERS) - only_matcher |
                         set(['treeStrategy', 'predictionModel']), 'one is not tested')
        for name, (default, other) in PARAMETERS.items():
            before = parameters(matcher)
            self.assertEqual(default, before[name], name)
            self.assertIsInstance(before[name], type(other), name)
            set_(matcher, name, other)
            before[name] = other
            self.assertEqual(before, parameters(matcher), name + ' changes another one, or nothing')

    def test_enumerations(self):
        self.assertEqual(5, len(set(PRESETS.values())))
        self.assertEqual(-1, cv.stereo.HDPTreeMatcher_AUTO)
        self.assertEqual(PRESETS['FAST'], cv.stereo.HDPTREE_MATCHER_PRESET_FAST)
        default = parameters(cv.stereo.HDPTreeMatcher.create())
        seen = []
        for name, preset in PRESETS.items():
            values = parameters(cv.stereo.HDPTreeMatcher.create(preset=preset))
            self.assertEqual(name == 'FAST', values == default)
            self.assertNotIn(values, seen)
            seen.append(values)

    def test_preset_is_its_parameters(self):
        for name, preset in PRESETS.items():
            expected = cv.stereo.HDPTreeMatcher.create(0, 32, preset)
            matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
            for parameter, value in parameters(expected).items():
                set_(matcher, parameter, value)
            matcher.setTreeStrategy(expected.getTreeStrategy())
            self.assertSame(expected.compute(self.left, self.right), matcher.compute(self.left, self.right))
            matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
            matcher.setParams(cv.stereo.HDPTreeMatcher.Params(preset))
            self.assertSame(expected.compute(self.left, self.right), matcher.compute(self.left, self.right))

    # ---- Images

    def test_compute(self):
        grey = [cv.cvtColor(image, cv.COLOR_BGR2GRAY) for image in (self.left, self.right)]
        limits = {'PAPER': 0.2, 'FAST': 0.02, 'ULTRAFAST': 0.06, 'QUALITY': 0.02, 'TREE': 0.02}
        for name, preset in PRESETS.items():
            for pair in ((self.left, self.right), grey):
                disparity = cv.stereo.HDPTreeMatcher.create(0, 32, preset).compute(*pair)
                self.assertEqual(np.int16, disparity.dtype)
                self.assertEqual(self.truth.shape, disparity.shape)
                self.assertLess(self.wrong(disparity / 16.0), limits[name], name)

    def test_one_channel_of_three_dimensions(self):
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        left, right = self.left[:, :, 1].copy(), self.right[:, :, 1].copy()
        self.assertSame(matcher.compute(left, right), matcher.compute(left[:, :, None], right[:, :, None]))

    def test_alpha_is_ignored(self):
        alpha = np.random.RandomState(8).randint(0, 256, (2,) + self.truth.shape).astype(np.uint8)
        for preset in PRESETS.values():
            matcher = cv.stereo.HDPTreeMatcher.create(0, 32, preset)
            expected = matcher.compute(self.left, self.right)
            self.assertSame(expected, matcher.compute(np.dstack((self.left, alpha[0])),
                                                      np.dstack((self.right, alpha[1]))))

    def test_16_bit(self):
        left, right = [cv.cvtColor(image, cv.COLOR_BGR2GRAY) for image in (self.left, self.right)]
        for name, preset in PRESETS.items():
            matcher = cv.stereo.HDPTreeMatcher.create(0, 32, preset)
            expected = matcher.compute(left, right)
            for factor in (1, 4, 16, 64, 256):
                self.assertSame(expected, matcher.compute(left.astype(np.uint16) * factor,
                                                          right.astype(np.uint16) * factor))
            # Others, of 12 bit
            disparity = matcher.compute(left.astype(np.uint16) * 14 + 9, right.astype(np.uint16) * 14 + 9)
            self.assertLess(self.wrong(disparity / 16.0), 1.1 * self.wrong(expected / 16.0) + 0.01, name)

    def test_memory_layouts(self):
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        views = {
            'region': lambda image: image[10:-7, 20:-3],
            'every second row': lambda image: image[::2],
            'every second column': lambda image: image[:, ::2],
            'upside down': lambda image: image[::-1],
            'mirrored': lambda image: image[:, ::-1],
            'RGB of BGR': lambda image: image[:, :, ::-1],
            'turned': lambda image: image.swapaxes(0, 1),
            'one channel': lambda image: image[:, :, 1],
            'by columns': np.asfortranarray,
            'one row': lambda image: image[5:6],
            'one column': lambda image: image[:, 5:6],
        }
        for name, view in views.items():
            left, right = view(self.left), view(self.right)
            expected = matcher.compute(left.copy(order='C'), right.copy(order='C'))
            self.assertEqual(left.shape[:2], expected.shape, name)
            self.assertSame(expected, matcher.compute(left, right))
            self.assertSame(expected, matcher.compute(left.copy(order='C'), right))

    def test_images_are_not_written_to(self):
        left, right = self.left.copy(), self.right.copy()
        for image in (left, right):
            image.flags.writeable = False
        for preset in PRESETS.values():
            cv.stereo.HDPTreeMatcher.create(-3, 32, preset).compute(left, right)
        self.assertSame(self.left, left)
        self.assertSame(self.right, right)

    def test_arrays_are_not_copied(self):
        # numpy reports to tracemalloc what it allocates for copies and for results, but not what C++ allocates.
        def allocated(left, right, disparity=None):
            tracemalloc.start()
            result = matcher.compute(left, right, disparity)
            peak = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
            self.assertEqual(disparity is not None, result is disparity)
            return peak

        small = 10000  # bytes
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        disparity = np.empty(self.left.shape[:2], np.int16)
        self.assertGreater(self.left.nbytes, 5 * small)
        self.assertLess(allocated(self.left, self.right, disparity), small)
        self.assertSame(disparity, matcher.compute(self.left, self.right))
        self.assertLess(allocated(self.left, self.right), disparity.nbytes + small)

        # Rows that are not next to each other need no copy,
        left, right = self.left[20:, 30:], self.right[20:, 30:]
        canvas = np.zeros(self.left.shape[:2], np.int16)
        self.assertLess(allocated(left, right, canvas[20:, 30:]), small)
        self.assertSame(canvas[20:, 30:], matcher.compute(left, right))
        self.assertFalse(canvas[:20].any() or canvas[:, :30].any())
        # pixels that are not do: this is what a copy looks like.
        self.assertGreater(allocated(left[:, ::-1], right[:, ::-1], disparity[20:, 30:]), left.nbytes + right.nbytes)

    def test_umat(self):
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        disparity = matcher.compute(cv.UMat(self.left), cv.UMat(self.right))
        self.assertSame(matcher.compute(self.left, self.right), disparity.get())

    def test_two_matchers_in_two_threads(self):
        expected = cv.stereo.HDPTreeMatcher.create(0, 32).compute(self.left, self.right)
        results = {}

        def match(key):
            matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
            results[key] = [matcher.compute(self.left, self.right) for _ in range(5)]

        threads = [threading.Thread(target=match, args=(key,)) for key in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for key in range(2):
            self.assertEqual(5, len(results[key]))
            for disparity in results[key]:
                self.assertSame(expected, disparity)

    # ---- What comes out beside the disparities

    def test_float_output(self):
        for diff in (-1, 1):
            matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
            matcher.setDisp12MaxDiff(diff)
            fixed_point = matcher.compute(self.left, self.right)
            matcher.setDisparityDepth(cv.CV_32F)
            pixels = matcher.compute(self.left, self.right)
            self.assertSame(fixed_point.astype(np.float32) / 16, pixels)
            self.assertEqual(diff == 1, pixels.min() == -1)

    def test_confidence(self):
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        self.assertIsNone(matcher.getConfidence())
        matcher.setDisp12MaxDiff(1)
        right = self.right.copy()  # of which a part matches nothing
        height, width = right.shape[:2]
        part = right[height // 3 : height // 2, width // 3 : width // 2]
        part[:] = np.random.RandomState(1).randint(0, 256, part.shape)
        disparity = matcher.compute(self.left, right)
        confidence = matcher.getConfidence()
        self.assertEqual((np.uint8, disparity.shape), (confidence.dtype, confidence.shape))
        rejected = disparity == -16
        self.assertTrue(rejected.any())
        self.assertFalse(confidence[rejected].any())
        kept = ~rejected & (self.truth > 0)
        wrong = np.abs(disparity / 16.0 - self.truth) >= 1
        self.assertGreater(confidence[kept & ~wrong].mean(), confidence[kept & wrong].mean() + 20)
        # As for any output array, the memory can be given.
        memory = np.zeros_like(confidence)
        self.assertIs(memory, matcher.getConfidence(memory))
        self.assertSame(confidence, memory)
        self.assertRaises(cv.error, matcher.compute, self.left, self.right[:-1])
        self.assertIsNone(matcher.getConfidence())

    def test_sigma_and_reasons(self):
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        self.assertIsNone(matcher.getDisparitySigma())
        self.assertIsNone(matcher.getReasons())
        matcher.setDisp12MaxDiff(1)
        mask = np.full(self.left.shape[:2], 255, np.uint8)
        mask[:20] = 0
        matcher.setMasks(mask, None)
        disparity = matcher.compute(self.left, self.right)
        sigma, reasons = matcher.getDisparitySigma(), matcher.getReasons()
        self.assertEqual((np.float32, disparity.shape), (sigma.dtype, sigma.shape))
        self.assertEqual((np.uint8, disparity.shape), (reasons.dtype, reasons.shape))
        self.assertSame(disparity < 0, np.isinf(sigma))
        self.assertGreater(sigma.min(), 0)
        self.assertSame(mask == 0, reasons == cv.stereo.HDPTreeMatcher_REASON_MASKED)
        matched = (reasons == cv.stereo.HDPTreeMatcher_REASON_MATCHED) & (disparity >= 0) & (self.truth > 0)
        self.assertGreater(matched.mean(), 0.5)
        error = np.abs(disparity / 16.0 - self.truth)
        self.assertGreater(np.mean(error[matched] <= 2 * sigma[matched]), 0.9)

    def test_row_alignment(self):
        moved = np.roll(self.right, 2, axis=0)  # the right camera looks 2 rows higher
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        matcher.compute(self.left, moved)
        findings = matcher.getFindings()
        self.assertTrue(findings.areRowsMoved)
        self.assertEqual(5, len(findings.rows))
        self.assertAlmostEqual(2, findings.rows[0], delta=0.1)
        matcher.compute(self.left, self.right)
        self.assertFalse(matcher.getFindings().areRowsMoved)
        self.assertTrue(findings.areRowsMoved, 'what was found before stays as it was')

    def test_noise_level(self):
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        self.assertEqual(0, matcher.getFindings().noise)
        rng = np.random.default_rng(1)
        noisy = [np.clip(np.rint(image + rng.normal(0, 8, image.shape)), 0, 255).astype(np.uint8)
                 for image in (self.left, self.right)]
        matcher.compute(*noisy)
        self.assertGreater(matcher.getFindings().noise, 3)

    def test_light_alignment(self):
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        matcher.compute(self.left, self.right // 2)
        self.assertTrue(matcher.getFindings().isLightChanged)
        model = matcher.getFindings().light
        self.assertEqual(10, len(model))
        level = 0.25  # of the darker image
        self.assertAlmostEqual(0.5, level * model[0] + model[7] + level**2 * model[8] + level**3 * model[9], delta=0.03)
        matcher.compute(self.left, self.right)
        self.assertFalse(matcher.getFindings().isLightChanged)

    def test_video(self):
        video = cv.stereo.HDPTreeMatcher.create(0, 32)
        video.setUseTemporalPrediction(True)
        rng = np.random.RandomState(3)
        frames = [[np.clip(image + rng.normal(0, 6, image.shape), 0, 255).astype(np.uint8)
                   for image in (self.left, self.right)] for _ in range(6)]
        single = [cv.stereo.HDPTreeMatcher.create(0, 32).compute(*frame) for frame in frames]
        maps = [video.compute(*frame) for frame in frames]
        np.testing.assert_array_equal(single[0], maps[0])
        flicker = [np.mean(np.abs(np.diff(m[-3:], axis=0))) for m in (np.array(single, float), np.array(maps, float))]
        self.assertLess(flicker[1], 0.5 * flicker[0])
        video.clear()
        np.testing.assert_array_equal(single[1], video.compute(*frames[1]))
        with self.assertRaises(cv.error):
            video.compute(self.left, self.left[1:])
        video.setUseTemporalPrediction(False)
        np.testing.assert_array_equal(single[2], video.compute(*frames[2]))

    def test_what_the_last_compute_did(self):
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32, PRESETS['PAPER'])
        self.assertEqual(0, len(matcher.getFindings().searchRatios))
        self.assertEqual((None, None), matcher.getForest())
        self.assertIsNone(matcher.getLayerDisparity(0))
        self.assertEqual(0, len(matcher.getFindings().stages))
        disparity = matcher.compute(self.left, self.right)
        ratios = matcher.getFindings().searchRatios
        self.assertEqual(3, len(ratios))
        self.assertEqual(1, ratios[2])
        self.assertTrue(0 < ratios[0] < 1)
        trees, intervals = matcher.getForest()
        self.assertEqual((np.int32, self.truth.shape), (trees.dtype, trees.shape))
        self.assertEqual((np.uint16, self.truth.shape + (2,)), (intervals.dtype, intervals.shape))
        self.assertTrue((intervals[..., 0] <= intervals[..., 1]).all() and intervals.max() < 32)
        self.assertEqual(set(range(trees.max() + 1)), set(trees.ravel()))
        widths = intervals[..., 1].astype(int) - intervals[..., 0] + 1
        self.assertAlmostEqual(ratios[0], widths.mean() / 32, places=6)
        self.assertEqual([32, 16, 0, 0], [len(matcher.getLayerPrior(layer)) for layer in range(4)])
        height, width = self.truth.shape
        for layer in range(3):
            found = matcher.getLayerDisparity(layer)
            self.assertEqual((np.float32, (height >> layer, width >> layer)), (found.dtype, found.shape))
        self.assertIsNone(matcher.getLayerDisparity(3))
        self.assertSame((disparity / 16.0).astype(np.float32), matcher.getLayerDisparity(0))
        stages, milliseconds = matcher.getFindings().stages, matcher.getFindings().stageTimes
        self.assertIn('cost aggregation', stages)
        self.assertEqual(len(stages), len(milliseconds))
        self.assertGreater(np.sum(milliseconds), 0)

    def test_pair_model(self):
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        self.assertTrue(matcher.getPairModel().empty())
        expected = matcher.compute(self.left, self.right)
        model = matcher.getPairModel()
        height, width = self.truth.shape
        self.assertEqual((width, height, 5, 10), (model.width, model.height, len(model.rows), len(model.light)))
        with tempfile.TemporaryDirectory() as folder:
            model.save(os.path.join(folder, 'model.yml'))
            matcher.setPairModel(cv.stereo.PairModel.load(os.path.join(folder, 'model.yml')))
        self.assertSame(expected, matcher.compute(self.left, self.right))
        matcher.setPairModel(model.tile(0, 0, 64, 48))
        self.assertEqual((48, 64), matcher.compute(self.left[:48, :64], self.right[:48, :64]).shape)
        matcher.setPairModel(cv.stereo.PairModel())
        self.assertSame(expected, matcher.compute(self.left, self.right))

    # ---- Tree strategies

    def test_tree_strategies(self):
        strategies = {
            'hdpstereo_MinimumSpanningTree': [cv.stereo.createMinimumSpanningTree()],
            'hdpstereo_SegmentTree': [cv.stereo.createSegmentTree(), cv.stereo.createSegmentTree(k=50)],
            'hdpstereo_RandomTree': [cv.stereo.createRandomTree(), cv.stereo.createRandomTree(seed=5)],
        }
        seen = []
        for prediction in (True, False):
            for name, variants in strategies.items():
                for strategy in variants:
                    self.assertIsInstance(strategy, cv.stereo.TreeStrategy)
                    matcher = cv.stereo.HDPTreeMatcher.create(0, 32, PRESETS['PAPER'])
                    change(matcher, usePrediction=prediction)
                    matcher.setTreeStrategy(strategy)
                    self.assertEqual(name, matcher.getTreeStrategy().getDefaultName())
                    disparity = matcher.compute(self.left, self.right)
                    self.assertLess(self.wrong(disparity / 16.0), 0.1 if prediction else 0.01, name)
                    if prediction:
                        self.assertFalse(any(np.array_equal(disparity, other) for other in seen), name)
                    seen.append(disparity)
        default = cv.stereo.HDPTreeMatcher.create(0, 32, PRESETS['PAPER'])
        self.assertEqual('hdpstereo_MinimumSpanningTree', default.getTreeStrategy().getDefaultName())
        self.assertSame(seen[0], default.compute(self.left, self.right))

    # ---- Prediction models

    def test_published_models(self):
        Model = cv.stereo.DisparityPredictionModel
        layers = {'PUBLISHED_LARGE': 3, 'PUBLISHED_SMALL': 2}
        for name, count in layers.items():
            model = Model.createPublished(getattr(cv.stereo, 'DisparityPredictionModel_' + name))
            self.assertEqual(count, model.getNumLayers(), name)
            for layer in range(count):
                means, sigmas, weights = model.getLayer(layer)
                self.assertTrue(len(means) == len(sigmas) == len(weights) > 0)
                self.assertAlmostEqual(1, np.sum(weights), delta=0.001)
                offset = 0.75
                densities = np.exp(-0.5 * ((offset - means) / sigmas) ** 2) / (np.sqrt(2 * np.pi) * sigmas)
                self.assertAlmostEqual(np.dot(weights, densities), model.density(layer, offset), places=9)

    def test_own_model(self):
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32, PRESETS['PAPER'])
        self.assertIsNone(matcher.getParams().predictionModel)
        expected = matcher.compute(self.left, self.right)

        model = cv.stereo.DisparityPredictionModel.create()
        self.assertEqual(0, model.getNumLayers())
        model.addLayer([0.0, 1.5], [0.75, 4.0], [0.25, 0.75])
        change(matcher, predictionModel=model)
        self.assertRejected('predictionModel must have numLayers - 1 = 2 layers, not 1',
                            matcher.compute, self.left, self.right)
        model.addLayer([0.5], [6.0], [1.0])  # the matcher has the same model
        self.assertEqual(2, matcher.getParams().predictionModel.getNumLayers())
        self.assertFalse(np.array_equal(expected, matcher.compute(self.left, self.right)))
        self.assertGreater(matcher.getLayerPrior(0).size, 0)
        change(matcher, predictionModel=None)
        self.assertIsNone(matcher.getParams().predictionModel)
        self.assertSame(expected, matcher.compute(self.left, self.right))

    def train_layer(self):
        '''Maps of a layer with offsets that are normal, of mean 1.'''
        rng = np.random.RandomState(3)
        halves = [rng.randint(8, 20, (30, 40)) for _ in range(4)]
        upper = [np.rint(half + rng.normal(1, 1.5, half.shape)).clip(0).astype(np.float32) for half in halves]
        disparities = [np.kron(2 * half, np.ones((2, 2))).astype(np.float32) for half in halves]
        return disparities, upper

    def test_training(self):
        disparities, upper = self.train_layer()
        offsets, counts = cv.stereo.DisparityPredictionModel.countOffsets(disparities, upper)
        self.assertEqual(sum(d.size for d in disparities), counts.sum())
        self.assertTrue((np.diff(offsets) > 0).all())

        model = cv.stereo.DisparityPredictionModel.create()
        try:
            likelihood = model.train(disparities, upper, maxComponents=2, seed=1)
        except cv.error as e:
            if e.code == cv.Error.StsNotImplemented:
                self.skipTest(e.err)
            raise
        self.assertAlmostEqual(-0.5 * np.log(2 * np.pi * np.e * (1.5 ** 2 + 1 / 12.0)), likelihood, delta=0.1)
        self.assertEqual(1, model.getNumLayers())
        means, _, weights = model.getLayer(0)
        self.assertAlmostEqual(1, np.dot(means, weights), delta=0.1)
        again = cv.stereo.DisparityPredictionModel.create()
        self.assertEqual(likelihood, again.train(disparities, upper, maxComponents=2, seed=1))
        np.testing.assert_array_equal(model.getLayer(0), again.getLayer(0))

        # Trained again for the next layer, it is ready for use.
        model.train(disparities, upper, maxComponents=1)
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32, PRESETS['PAPER'])
        expected = matcher.compute(self.left, self.right)
        change(matcher, predictionModel=model)
        self.assertFalse(np.array_equal(expected, matcher.compute(self.left, self.right)))

    def test_model_files(self):
        model = cv.stereo.DisparityPredictionModel.createPublished(cv.stereo.DisparityPredictionModel_PUBLISHED_SMALL)
        for extension in ('yml', 'xml', 'json'):
            filename = self.path('model.' + extension)
            model.save(filename)
            loaded = cv.stereo.DisparityPredictionModel.load(filename)
            self.assertEqual(model.getNumLayers(), loaded.getNumLayers())
            for layer in range(model.getNumLayers()):
                np.testing.assert_array_equal(model.getLayer(layer), loaded.getLayer(layer))

    # ---- Files of a matcher

    def test_matcher_files(self):
        matcher = cv.stereo.HDPTreeMatcher.create(-3, 40, PRESETS['PAPER'])
        for name, (_, other) in PARAMETERS.items():
            set_(matcher, name, other)
        matcher.setTreeStrategy(cv.stereo.createSegmentTree(77))
        change(matcher, predictionModel=cv.stereo.DisparityPredictionModel.createPublished(
            cv.stereo.DisparityPredictionModel_PUBLISHED_SMALL))
        expected = matcher.compute(self.left, self.right)
        for extension in ('yml', 'xml', 'json'):
            filename = self.path('matcher.' + extension)
            matcher.save(filename)
            loaded = read_matcher(filename)
            self.assertEqual(parameters(matcher), parameters(loaded))
            self.assertEqual('hdpstereo_SegmentTree', loaded.getTreeStrategy().getDefaultName())
            self.assertEqual(2, loaded.getParams().predictionModel.getNumLayers())
            self.assertSame(expected, loaded.compute(self.left, self.right))

        storage = cv.FileStorage(self.path('written.yml'), cv.FileStorage_WRITE)
        matcher.write(storage, 'stereo')
        storage.release()
        self.assertEqual(parameters(matcher), parameters(read_matcher(self.path('written.yml'))))

    def test_hostile_file(self):
        matcher = cv.stereo.HDPTreeMatcher.create(-3, 40)
        before = parameters(matcher)
        filename = self.path('hostile.yml')
        storage = cv.FileStorage(filename, cv.FileStorage_WRITE)
        matcher.write(storage, 'stereo')
        storage.release()
        with open(filename) as f:
            text = f.read()
        for old, new, message in (('numDisparities: 40', 'numDisparities: -1', 'numDisparities must be >= 0, not -1'),
                                  ('blockSize: 7', 'blockSize: 4.5', 'blockSize must be a number'),
                                  ('minDisparity: -3', 'minDisparity: none', 'minDisparity must be a number')):
            self.assertIn(old, text)
            with open(filename, 'w') as f:
                f.write(text.replace(old, new))
            storage = cv.FileStorage(filename, cv.FileStorage_READ)
            with self.assertRaises(cv.error) as context:
                matcher.read(storage.getFirstTopLevelNode())
            storage.release()
            self.assertEqual(message, context.exception.err)
            self.assertEqual(before, parameters(matcher))

    # ---- Errors

    def test_bad_parameters(self):
        matcher = cv.stereo.HDPTreeMatcher.create(-3, 40)
        before = parameters(matcher)
        for setter, value, message in (
                ('NumDisparities', -1, 'numDisparities must be >= 0, not -1'),
                ('SpeckleRange', -1, 'speckleRange must be >= 0, not -1'),
                ('NumLayers', 17, 'numLayers must be in 1..16, not 17'),
                ('MaxTopDisparities', -1, 'maxTopDisparities must be >= 0, not -1'),
                ('MaxRowOffset', -1, 'maxRowOffset must be >= 0, not -1'),
                ('Delta0', 1.0, 'delta0 must be in [0, 1) or AUTO, not 1'),
                ('Beta', 1.5, 'beta must be in [0, 1] or AUTO, not 1.5'),
                ('Gamma', 0, 'gamma must be finite and > 0, not 0'),
                ('Gamma', float('nan'), 'gamma must be finite and > 0, not nan'),
                ('ColorTruncation', -0.5, 'colorTruncation must be finite and >= 0, not -0.5'),
                ('GradientTruncation', float('inf'), 'gradientTruncation must be finite and >= 0, not inf'),
                ('ColorWeight', 1.25, 'colorWeight must be in [0, 1], not 1.25'),
                ('DisparityMedianSize', 4, 'disparityMedianSize must be 0, 3, 5, 7 or AUTO, not 4'),
                ('MatchingCost', 2, 'matchingCost must be COST_COLOR_GRADIENT or COST_CENSUS, not 2'),
                ('DisparityPrior', -1, 'disparityPrior must be PRIOR_SUPPORT_POINTS or PRIOR_UPPER_LAYER, not -1'),
                ('IntervalMargin', 65, 'intervalMargin must be in 0..64, not 65'),
                ('Aggregation', 3, 'aggregation must be AGGREGATION_TREES, AGGREGATION_SCANLINES or '
                                   'AGGREGATION_TREE_SCANLINES, not 3'),
                ('P1', 101, 'P1 must be in 0..100, not 101'),
                ('P2', -1, 'P2 must be in 0..100, not -1'),
                ('FinestLayer', 16, 'finestLayer must be in 0..15, not 16'),
                ('ScanlinePasses', 5, 'scanlinePasses must be in 1..4, not 5'),
                ('DisparityDepth', cv.CV_8U, 'disparityDepth must be CV_16S or CV_32F, not 0'),
                ('TreeStrategy', None, 'treeStrategy must not be empty')):
            self.assertRejected(message, set_, matcher, setter, value)
        self.assertRejected('numDisparities must be >= 0, not -16', cv.stereo.HDPTreeMatcher.create, 0, -16)
        self.assertRejected('preset must be one of HDPTreeMatcher::PRESET_*, 0..4, not 9; it is no blockSize, which '
                 'setBlockSize() sets',
                            cv.stereo.HDPTreeMatcher.create, 0, 16, 9)
        self.assertRejected('k must be finite and >= 0', cv.stereo.createSegmentTree, -1)
        self.assertRejected('seed must be >= 0', cv.stereo.createRandomTree, -1)
        self.assertRejected('which must be PUBLISHED_LARGE or PUBLISHED_SMALL',
                            cv.stereo.DisparityPredictionModel.createPublished, 9)
        model = cv.stereo.DisparityPredictionModel.create()
        self.assertRejected('sigmas must be finite and > 0', model.addLayer, [0.0], [0.0], [1.0])
        self.assertRejected('the sum of weights must be 1', model.addLayer, [0.0], [1.0], [0.5])
        self.assertRejected("filename: '" + self.path('none.yml') + "' does not hold a model: cannot read it",
                            cv.stereo.DisparityPredictionModel.load, self.path('none.yml'))
        self.assertEqual(0, model.getNumLayers())
        for bad in ('wide', [1], {}):  # not a number: an error of the bindings
            self.assertRaises((TypeError, cv.error), change, matcher, gamma=bad)
        self.assertEqual(before, parameters(matcher))

    def test_masks(self):
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        mask = np.full(self.left.shape[:2], 255, np.uint8)
        mask[20:40, 50:80] = 0
        matcher.setMasks(mask, None)
        np.testing.assert_array_equal(mask == 0, matcher.compute(self.left, self.right) < 0)
        self.assertRaises(cv.error, lambda: matcher.setMasks(mask.astype(np.int16), None))

    def test_bad_images(self):
        left, right = self.left, self.right
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        expected = matcher.compute(left, right)
        grey = left[:, :, 0].copy()
        types = 'left must be CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1 or CV_32FC1, not '
        for message, pair in (
                ('left must not be empty', (None, right)),
                ('left must not be empty', (left[:0], right[:0])),
                (types + 'CV_16UC3', (left.astype(np.uint16), right.astype(np.uint16))),
                (types + 'CV_16SC1', (grey.astype(np.int16), grey.astype(np.int16))),
                (types + 'CV_64FC1', (grey / 255.0, grey / 255.0)),
                (types + 'CV_32SC1', (grey.astype(np.int64), grey.astype(np.int64))),
                (types + 'CV_8UC2', (left[:, :, :2], right[:, :, :2])),
                ('left must be an image, not an array of 4 dimensions', (np.zeros((4, 4, 3, 2), np.uint8),) * 2),
                ('right must have the type of left, CV_8UC1, not CV_16UC1', (grey, grey.astype(np.uint16))),
                ('right must have the size of left, %d x %d, not %d x %d' % (left.shape[1::-1] + right[:-1].shape[1::-1]),
                 (left, right[:-1])),
                ('right must have the size of left, %d x %d, not 0 x 0' % left.shape[1::-1], (left, None)),
                ('right must have the type of left, CV_8UC3, not CV_8UC1', (left, grey))):
            self.assertRejected(message, matcher.compute, *pair)
        self.assertRaises(cv.error, matcher.compute, left.tolist(), right.tolist())
        self.assertRaises(cv.error, matcher.compute, left > 7, right > 7)  # bool
        matcher.setMinDisparity(2000)
        matcher.setNumDisparities(200)
        self.assertRejected('minDisparity - 1 and minDisparity + numDisparities - 1 must be in -2048..2047, as CV_16S has '
                            'them times 16; minDisparity is 2000 and numDisparities 200', matcher.compute, left, right)
        matcher.setMinDisparity(0)
        matcher.setNumDisparities(32)
        self.assertSame(expected, matcher.compute(left, right))  # as usable as before

    # ---- In the place of cv.StereoSGBM

    def test_create_like(self):
        sgbm = cv.StereoSGBM.create(-2, 48, 5, P1=8 * 75, P2=32 * 75, disp12MaxDiff=1, speckleWindowSize=100,
                                    speckleRange=2)
        matcher = cv.stereo.HDPTreeMatcher.createLike(sgbm, PRESETS['QUALITY'])
        expected = cv.stereo.HDPTreeMatcher.create(-2, 48, PRESETS['QUALITY'])
        for name, value in (('Disp12MaxDiff', 1), ('SpeckleWindowSize', 100), ('SpeckleRange', 2)):
            set_(expected, name, value)
        self.assertEqual(parameters(expected), parameters(matcher))
        self.assertRejected('sgbm must not be empty', cv.stereo.HDPTreeMatcher.createLike, None)

    def test_flow_of_stereo_match(self):
        # What OpenCV's samples/python/stereo_match.py does
        min_disp, num_disp = 2, 14
        stereo = cv.stereo.HDPTreeMatcher.create(minDisparity=min_disp, numDisparities=num_disp)
        for name, value in (('BlockSize', 5), ('Disp12MaxDiff', 1), ('SpeckleWindowSize', 100), ('SpeckleRange', 32)):
            set_(stereo, name, value)
        disp = stereo.compute(self.left, self.right).astype(np.float32) / 16.0
        h, w = self.left.shape[:2]
        f = 0.8 * w
        Q = np.float32([[1, 0, 0, -0.5 * w], [0, -1, 0, 0.5 * h], [0, 0, 0, -f], [0, 0, 1, 0]])
        points = cv.reprojectImageTo3D(disp, Q)
        colors = cv.cvtColor(self.left, cv.COLOR_BGR2RGB)
        mask = disp > disp.min()
        self.assertEqual(min_disp - 1, disp.min())
        self.assertTrue(mask.mean() > 0.8)
        vertices = np.hstack([points[mask], colors[mask]])
        with open(self.path('out.ply'), 'wb') as file:
            names = ['property float ' + c for c in 'xyz'] + ['property uchar ' + c for c in ('red', 'green', 'blue')]
            file.write(('ply\nformat ascii 1.0\nelement vertex %d\n%s\nend_header\n'
                        % (len(vertices), '\n'.join(names))).encode('utf-8'))
            np.savetxt(file, vertices, fmt='%f %f %f %d %d %d ')

        read = read_ply(self.path('out.ply'))
        self.assertEqual(np.count_nonzero(mask), len(read))
        np.testing.assert_allclose(read, vertices, atol=1e-5)
        # Each point is where its pixel's disparity puts it; most of them on one of two planes.
        y, x = np.nonzero(mask)
        depth = -f / disp[mask]
        np.testing.assert_allclose(read[:, 2], depth, rtol=1e-4)
        np.testing.assert_allclose(read[:, 0], (x - 0.5 * w) / disp[mask], atol=1e-3)
        np.testing.assert_allclose(read[:, 1], (0.5 * h - y) / disp[mask], atol=1e-3)
        on_planes = (np.abs(depth + f / 4) < f / 4 / 8) | (np.abs(depth + f / 11) < f / 11 / 20)
        self.assertGreater(on_planes.mean(), 0.95)

    def test_valid_disparity_roi(self):
        # cv.getValidDisparityROI and cv.validateDisparity take our disparities as they take those of cv.StereoSGBM.
        h, w = self.truth.shape
        matcher = cv.stereo.HDPTreeMatcher.create(0, 32)
        disparity = matcher.compute(self.left, self.right)
        x, y, width, height = cv.getValidDisparityROI((0, 0, w, h), (0, 0, w, h), 0, 32, matcher.getBlockSize())
        inside = np.zeros(self.truth.shape, bool)
        inside[y:y + height, x:x + width] = True
        self.assertGreater(width * height, 0.6 * w * h)
        self.assertLess(np.mean(np.abs(disparity / 16.0 - self.truth)[inside] >= 1), 0.05)

        validated = cv.validateDisparity(disparity.copy(), np.zeros(disparity.shape, np.int16), 0, 32, 1)
        matcher.setDisp12MaxDiff(1)
        rejected = matcher.compute(self.left, self.right) == -16
        self.assertGreater(np.mean(rejected == (validated == -16)), 0.9)

    def test_rig(self):
        h, w = self.truth.shape
        calibration = cv.stereo.StereoCalibration()
        calibration.imageSize = (w, h)
        calibration.cameraMatrix1 = np.array([[200, 0, w / 2], [0, 200, h / 2], [0, 0, 1.0]])
        calibration.cameraMatrix2 = calibration.cameraMatrix1
        calibration.distCoeffs1 = calibration.distCoeffs2 = np.zeros((1, 5))
        calibration.R = np.eye(3)
        calibration.T = np.array([[-0.1], [0], [0]])
        rig = cv.stereo.StereoRig.create(calibration)
        left, right = rig.rectify(self.left, self.right)
        self.assertEqual(self.left.shape, left.shape)
        self.assertEqual((w, h), rig.getSize())
        disparity = cv.stereo.HDPTreeMatcher.create(0, 32).compute(left, right)
        depth = rig.computeDepth(disparity)
        near = disparity > 16
        np.testing.assert_allclose(rig.getFocalLength() * 1.6 / disparity[near], depth[near], rtol=1e-4)
        _, R2, _, P2, _ = rig.getRectification()
        drift = cv.stereo.RigDrift.create(P2, rig.getSize())
        self.assertTrue(drift.add([0.5, 0, 0, 0, 0]))
        values, deviations = drift.getEstimate()
        self.assertLess(abs(values[0] - np.degrees(0.5 / P2[0, 0])), 0.02)
        self.assertEqual(4, len(deviations))
        self.assertGreater(drift.correct(calibration, R2).R[1, 2], 0.001)
        with self.assertRaisesRegex(cv.error, 'none.yaml'):
            cv.stereo.readStereoCalibration('none.yaml')


if __name__ == '__main__':
    unittest.main()
