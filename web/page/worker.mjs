// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Everything that takes time: reads images, and matches them. Each message has an id, and so has its answer.

import { encodeDownload } from './downloads.mjs';
import { halvesOf } from './image_data.mjs';
import { decodeImage } from './images.mjs';
import { decodeDisparity, decodeFindings, decodeMask } from './known_files.mjs';

let hdp = null;
let parameters = []; // as parameters.json has them
let pair = null;
let video = null; // a matcher, from frame to frame

function presetNumber(name) {
    return hdp[`PRESET_${name}`];
}

function readParameters(matcher) {
    const values = { treeStrategy: matcher.getTreeStrategy(), ...matcher.getParams() };
    for (const { name, method } of parameters) if (method) values[name] = matcher[`get${method}`]();
    return values;
}

// What each preset amounts to
function presetValues(names) {
    const values = {};
    for (const name of names) {
        const matcher = hdp.HDPTreeMatcher.create(0, 64, presetNumber(name));
        values[name] = readParameters(matcher);
        matcher.delete();
    }
    return values;
}

function applySettings(matcher, { minDisparity, numDisparities, changes }) {
    matcher.setMinDisparity(minDisparity);
    matcher.setNumDisparities(numDisparities);
    const fields = {}; // of Params
    for (const [name, value] of Object.entries(changes)) {
        const parameter = parameters.find(p => p.name === name);
        if (parameter && !parameter.method) fields[name] = value;
        else matcher[`set${parameter ? parameter.method : 'TreeStrategy'}`](value);
    }
    matcher.setParams(fields);
}

function createMatcher(settings) {
    const matcher = hdp.HDPTreeMatcher.create(
        settings.minDisparity,
        settings.numDisparities,
        presetNumber(settings.preset),
    );
    try {
        applySettings(matcher, settings);
    } catch (error) {
        matcher.delete();
        throw error;
    }
    return matcher;
}

function applyKnown(matcher, { leftMask, rightMask, smallest, largest, disparity, sigma, findings }) {
    matcher.setMasks(leftMask, rightMask);
    matcher.setDisparityRange(smallest, largest);
    matcher.setPriorDisparity(disparity, sigma);
    matcher.setPairModel(findings);
}

function checkFindings(text) {
    const matcher = hdp.HDPTreeMatcher.create(0, 0, hdp.PRESET_FAST);
    try {
        matcher.setPairModel(text);
    } finally {
        matcher.delete();
    }
}

const decoders = {
    image: decodeImage,
    mask: decodeMask,
    disparity: decodeDisparity,
    findings: file => decodeFindings(file, checkFindings),
};

function findings(matcher) {
    const found = matcher.getFindings();
    return {
        noise: found.noise,
        noiseThreshold: matcher.getNoiseThreshold(),
        rows: {
            sought: matcher.getMaxRowOffset() > 0,
            moved: found.areRowsMoved,
            model: found.rows,
            error: found.rowError,
        },
        light: { sought: matcher.getUseLightAlignment(), changed: found.isLightChanged, model: found.light },
        range: { sought: matcher.getNumDisparities() === 0 },
        ratios: found.searchRatios,
        times: { stages: found.stages, milliseconds: found.stageTimes },
    };
}

// isWhole: with sigma and reasons, which take half as long as a map
function resultOf(matcher, disparity, start, isWhole) {
    const { minDisparity, numDisparities } = matcher.getFindings();
    return {
        width: disparity.width,
        height: disparity.height,
        disparity: disparity.data,
        minDisparity,
        numDisparities,
        confidence: matcher.getConfidence().data,
        sigma: isWhole ? matcher.getDisparitySigma().data : null,
        reasons: isWhole ? matcher.getReasons().data : null,
        milliseconds: disparity.milliseconds,
        elapsed: performance.now() - start,
        found: findings(matcher),
        model: matcher.getPairModel(),
    };
}

const transferable = ({ disparity, confidence, sigma, reasons }) =>
    [disparity, confidence, sigma, reasons].filter(Boolean).map(({ buffer }) => buffer);

const actions = {
    async start({ name, module, documentation, threads }) {
        parameters = documentation.parameters;
        const { default: createHDPStereo } = await import(`./${name}.mjs`);
        hdp = await new Promise((resolve, reject) => {
            const instantiateWasm = (imports, receive) => {
                WebAssembly.instantiate(module, imports).then(instance => receive(instance, module), reject);
                return {};
            };
            createHDPStereo({ instantiateWasm }).then(resolve, reject);
        });
        hdp.setNumThreads(threads);
        const presets = documentation.enumerations.Preset.map(({ name }) => name.replace('PRESET_', ''));
        return [{ presets: presetValues(presets), version: hdp.openCVVersion, threads: hdp.getNumThreads() }];
    },

    async decode({ file, kind }) {
        const decoded = await decoders[kind](file);
        return [decoded, kind === 'findings' ? [] : [decoded.data.buffer]];
    },

    setPair({ left, right, known }) {
        pair = { left, right, known };
        return [{}];
    },

    match({ settings }) {
        const start = performance.now(),
            matcher = createMatcher(settings);
        try {
            applyKnown(matcher, pair.known);
            const result = resultOf(matcher, matcher.compute(pair.left, pair.right), start, true);
            return [result, transferable(result)];
        } finally {
            matcher.delete();
        }
    },

    // A matcher for a video, or none
    setVideo({ settings }) {
        video?.delete();
        video = null;
        if (settings) video = createMatcher(settings);
        return [{}];
    },

    frame({ frame, isWhole }) {
        const start = performance.now(),
            [left, right] = halvesOf(frame);
        const result = { ...resultOf(video, video.compute(left, right), start, isWhole), left };
        return [result, [...transferable(result), left.data.buffer]];
    },

    encode(request) {
        const bytes = encodeDownload(request);
        return [bytes, [bytes.buffer]];
    },
};

async function answer({ id, action, ...request }) {
    try {
        const [result, transfer = []] = await actions[action](request);
        postMessage({ id, answer: result }, transfer);
    } catch (error) {
        postMessage({ id, error: error.message || String(error) });
    }
}

// One after the other, also those that wait for something
let last = Promise.resolve();
onmessage = ({ data }) => {
    last = last.then(() => answer(data));
};
