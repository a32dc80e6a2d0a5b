// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// hdpstereo.wasm gives the maps of the native program, to the bit. The module runs in node here, and alone.

import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { pathToFileURL } from 'node:url';
import { floatsOfPfm, matchNatively, pageFolder, pairs, presets } from './pictures.mjs';

const { reasonWords } = await import(pathToFileURL(join(pageFolder, 'reasons.mjs')));
const { default: create } = await import(pathToFileURL(join(pageFolder, 'hdpstereo.mjs')));
const hdp = await create({ wasmBinary: readFileSync(join(pageFolder, 'hdpstereo.wasm')) });

const hash = array =>
    createHash('sha256')
        .update(new Uint8Array(array.buffer, array.byteOffset, array.byteLength))
        .digest('hex');

// From the first row on, in 1/16 pixel
function nativeMap(pair, preset) {
    const { width, height } = pair.images.left,
        floats = floatsOfPfm(matchNatively(pair, preset, 'native.pfm'));
    const map = new Int16Array(width * height);
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++) map[y * width + x] = 16 * floats[(height - 1 - y) * width + x];
    return map;
}

for (const pair of pairs)
    for (const preset of presets)
        test(`${pair.name} pair, ${preset}: the map of the native program`, () => {
            const matcher = hdp.HDPTreeMatcher.create(pair.minDisparity, pair.numDisparities, hdp[`PRESET_${preset}`]);
            const { left, right } = pair.images,
                { data } = matcher.compute(left, right),
                expected = nativeMap(pair, preset);
            assert.equal(hash(data), hash(expected));
            assert.ok(new Set(data).size > 20, 'a map of something');
            matcher.delete();
        });

test('the pairs have rows to move, light to change and noise', () => {
    const matcher = hdp.HDPTreeMatcher.create(-5, 70, hdp.PRESET_FAST),
        { left, right } = pairs[2].images;
    matcher.compute(left, right);
    const { rows, areRowsMoved, isLightChanged, noise } = matcher.getFindings();
    assert.equal(areRowsMoved, true);
    assert.ok(Math.abs(Math.abs(rows[0]) - 2) < 0.3, `${rows}`);
    assert.equal(isLightChanged, true);
    assert.ok(noise > 3);
    matcher.delete();
});

test('setters take what getters return, and refuse what is out of range', () => {
    const { parameters } = JSON.parse(readFileSync(join(pageFolder, 'parameters.json')));
    assert.ok(parameters.length > 30);
    const matcher = hdp.HDPTreeMatcher.create(0, 64, hdp.PRESET_QUALITY);
    for (const { name, method, brief, text } of parameters) {
        const get = () => (method ? matcher[`get${method}`]() : matcher.getParams()[name]),
            value = get();
        assert.notEqual(value, undefined, name);
        if (method) matcher[`set${method}`](value);
        else matcher.setParams({ [name]: value });
        assert.equal(get(), value, name);
        assert.ok(brief.length > 10 && !/[\\@{}]/.test(text), `${name}: ${text}`);
    }
    assert.throws(() => matcher.setParams({ P1: 101 }), /P1 must be in 0..100, not 101/);
    assert.throws(() => matcher.setTreeStrategy('oak'), /treeStrategy must be MST, ST or RT/);
    assert.throws(() => hdp.HDPTreeMatcher.create(0, -1, hdp.PRESET_FAST), /numDisparities must be >= 0/);
    const { left } = pairs[0].images;
    assert.throws(() => matcher.compute(left, pairs[2].images.right), /size/);
    assert.throws(() => matcher.compute({ ...left, width: 0 }, left), /left/);
    matcher.delete();
});

test('all results of a run', () => {
    const matcher = hdp.HDPTreeMatcher.create(0, 64, hdp.PRESET_PAPER),
        { left, right } = pairs[0].images;
    assert.equal(matcher.getConfidence(), null);
    const map = matcher.compute(left, right),
        confidence = matcher.getConfidence();
    assert.deepEqual([map.width, map.height, confidence.width, confidence.height], [640, 480, 640, 480]);
    assert.ok(confidence.data instanceof Uint8Array && confidence.data.some(value => value > 100));
    const { searchRatios, stages, stageTimes } = matcher.getFindings();
    assert.equal(searchRatios.length, 3);
    assert.ok(stages.length > 5 && stages.length === stageTimes.length);
    const { trees, intervals } = matcher.getForest();
    assert.ok(trees.data instanceof Int32Array && intervals.data.length === 2 * trees.data.length);
    assert.ok(matcher.getLayerPrior(0).length > 10);
    matcher.setDisparityDepth(5); // CV_32F
    const sigma = matcher.getDisparitySigma(),
        reasons = matcher.getReasons();
    assert.ok(sigma.data instanceof Float32Array && sigma.data.every(value => value > 0 && value < 100));
    assert.ok(reasons.data.includes(hdp.REASON_MATCHED) && reasons.data.includes(hdp.REASON_OCCLUDED));
    const codes = Object.keys(hdp).filter(name => name.startsWith('REASON_'));
    assert.deepEqual(codes.map(name => hdp[name]).sort(), [...reasonWords.keys()]);
    const { data } = matcher.compute(left, right);
    assert.ok(data instanceof Float32Array && data.every((value, i) => 16 * value === map.data[i]));
    matcher.delete();
});

test('what is known beforehand', () => {
    const matcher = hdp.HDPTreeMatcher.create(0, 0, hdp.PRESET_FAST),
        { left, right } = pairs[0].images,
        { width, height } = left;
    const empty = matcher.getPairModel();
    matcher.compute(left, right);
    const { minDisparity, numDisparities } = matcher.getFindings(),
        model = matcher.getPairModel();
    assert.ok(numDisparities > 30 && numDisparities < 128, `${numDisparities}`);
    assert.match(model, /width: 640/);
    assert.notEqual(model, empty);

    const mask = { width, height, data: new Uint8Array(width * height).fill(255) };
    mask.data.fill(0, 0, 100);
    matcher.setMasks(mask, null);
    matcher.setPairModel(model);
    const { data } = matcher.compute(left, right);
    assert.ok(data.subarray(0, 100).every(value => value === 16 * (minDisparity - 1)));
    assert.ok(
        matcher
            .getReasons()
            .data.subarray(0, 100)
            .every(value => value === hdp.REASON_MASKED),
    );
    assert.equal(matcher.getPairModel(), model);
    assert.throws(() => matcher.setPairModel('some notes'));
    assert.throws(() => matcher.setPairModel('%YAML:1.0\n---\nnoise: 1\n'), /pairModel is missing/);
    matcher.setPairModel(null);

    const prior = { width, height, data: new Float32Array(width * height).fill(NaN) };
    matcher.setPriorDisparity(prior, 0.5);
    assert.throws(() => matcher.setPriorDisparity({ ...prior, data: prior.data.fill(1) }, -1), /sigma must be finite/);
    matcher.delete();
});
