// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Pairs for the tests, all from the one that is built in: as PNG, and as the matcher takes them

import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { decode, encode } from 'fast-png';

// Folders and programs, from scripts/check_web.sh
export const pageFolder = process.env.HDPSTEREO_PAGE;
export const workFolder = process.env.HDPSTEREO_WEB_WORK;
export const nativeProgram = process.env.HDPSTEREO_NATIVE; // hdpstereo
export const presets = ['ULTRAFAST', 'FAST', 'QUALITY', 'TREE', 'PAPER'];

mkdirSync(workFolder, { recursive: true });

export function readPng(file) {
    return decode(readFileSync(file));
}

// Returns the path of a file.
export function writePng(name, { width, height, data, channels }) {
    const file = join(workFolder, name);
    writeFileSync(file, encode({ width, height, data, channels, depth: 8 * data.BYTES_PER_ELEMENT }));
    return file;
}

// value(i) for each value of an image of a size
function make(type, width, height, channels, value) {
    const data = new type(width * height * channels);
    for (let i = 0; i < data.length; i++) data[i] = value(i);
    return { width, height, channels, data };
}

// Uniform in [0, 1), the same for each seed
function generator(seed) {
    let state = seed;
    return () => {
        state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
        return state / 4294967296;
    };
}

const original = Object.fromEntries(
    ['left', 'right'].map(side => [side, readPng(join(pageFolder, 'pair', `${side}.png`))]),
);

const grey = ({ data }, pixel) => 0.299 * data[3 * pixel] + 0.587 * data[3 * pixel + 1] + 0.114 * data[3 * pixel + 2];

// Of 12 bits in 16
function deep(side) {
    const image = original[side],
        random = generator(side.length);
    return make(Uint16Array, image.width, image.height, 1, i => Math.round(16 * grey(image, i) + 15 * random()));
}

// A part of odd size; the right image has other rows, another exposure and noise.
function poor(side) {
    const { width, data } = original[side],
        random = generator(7 + side.length),
        left = 60,
        top = 90,
        columns = 411;
    const [offset, gain] = side === 'left' ? [0, 1] : [2, 0.7];
    return make(Uint8Array, columns, 303, 3, i => {
        const pixel = Math.floor(i / 3),
            x = left + (pixel % columns),
            y = top + offset + Math.floor(pixel / columns);
        return Math.min(
            255,
            Math.round(gain * data[3 * (y * width + x) + (i % 3)] + 24 * (random() + random() - 1) + 8),
        );
    });
}

// Each pixel `factor` times in both directions
export function enlarge({ width, height, channels, data }, factor) {
    return make(data.constructor, width * factor, height * factor, channels, i => {
        const c = i % channels,
            pixel = Math.floor(i / channels);
        const x = pixel % (width * factor),
            y = Math.floor(pixel / (width * factor));
        return data[channels * (Math.floor(y / factor) * width + Math.floor(x / factor)) + c];
    });
}

export function sideBySide({ left, right }) {
    const { width, height, channels, data } = left;
    return make(data.constructor, 2 * width, height, channels, i => {
        const c = i % channels,
            pixel = Math.floor(i / channels),
            x = pixel % (2 * width),
            y = Math.floor(pixel / (2 * width));
        return (x < width ? left : right).data[channels * (y * width + (x % width)) + c];
    });
}

export const pairs = [
    { name: 'built-in', minDisparity: 0, numDisparities: 64, images: original },
    { name: 'deep', minDisparity: 3, numDisparities: 61, images: { left: deep('left'), right: deep('right') } },
    { name: 'poor', minDisparity: -5, numDisparities: 70, images: { left: poor('left'), right: poor('right') } },
];
for (const pair of pairs)
    pair.files = ['left', 'right'].map(side => writePng(`${pair.name}_${side}.png`, pair.images[side]));

// What samples/hdp_stereo_match.cpp writes for a pair; output: its name ends with png, pfm or ply
export function matchNatively({ files, minDisparity, numDisparities }, preset, output, options = []) {
    const file = join(workFolder, output),
        option = output.endsWith('.ply') ? 'point-cloud' : 'output';
    execFileSync(nativeProgram, [
        ...files,
        `--preset=${preset.toLowerCase()}`,
        `--min-disparity=${minDisparity}`,
        `--num-disparities=${numDisparities}`,
        `--${option}=${file}`,
        ...options,
    ]);
    return readFileSync(file);
}

// The floats of a PFM file, in its order
export function floatsOfPfm(bytes) {
    let at = 0;
    for (let lines = 0; lines < 3; at++) if (bytes[at] === 10) lines++;
    const copy = Uint8Array.from(bytes.subarray(at));
    return new Float32Array(copy.buffer);
}
