// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Maps as files: the same as those of samples/hdp_stereo_match.py

import { scale } from './disparities.mjs';
import { channelsOf, levelsOf } from './image_data.mjs';
import { encode } from './vendor/png.mjs';

// 256 times the disparity, 0 where there is none
function encodePng({ width, height, disparity, invalid }) {
    const data = Uint16Array.from(disparity, value =>
        value === invalid || value < 0 || value >= 256 * scale ? 0 : Math.max((value * 256) / scale, 1),
    );
    return encode({ width, height, data, channels: 1, depth: 16 });
}

// Floating point, the last row first
function encodeFloats({ width, height }, valueOf) {
    const header = new TextEncoder().encode(`Pf\n${width} ${height}\n-1.0\n`);
    const bytes = new Uint8Array(header.length + 4 * width * height),
        view = new DataView(bytes.buffer);
    bytes.set(header);
    let at = header.length;
    for (let y = height - 1; y >= 0; y--)
        for (let x = 0; x < width; x++, at += 4) view.setFloat32(at, valueOf(y * width + x), true);
    return bytes;
}

// Infinite where there is none
function encodePfm(result) {
    const { disparity, invalid } = result;
    return encodeFloats(result, i => (disparity[i] === invalid ? Infinity : disparity[i] / scale));
}

const encodeSigma = result => encodeFloats(result, i => result.sigma[i]);

const encodeFindings = ({ model }) => new TextEncoder().encode(model);

// What point(x, y, z, i) gets of each pixel i with a depth; x to the right, y down, z away from the camera
export function forEachPoint(result, point, step = 1) {
    const { width, height, disparity, confidence, invalid, threshold, focal, baseline } = result;
    const centerX = 0.5 * (width - 1),
        centerY = 0.5 * (height - 1);
    for (let y = 0; y < height; y += step)
        for (let x = 0; x < width; x += step) {
            const i = y * width + x,
                value = disparity[i] / scale;
            if (disparity[i] !== invalid && value > 0 && confidence[i] >= threshold)
                point(
                    ((x - centerX) * baseline) / value,
                    ((y - centerY) * baseline) / value,
                    (focal * baseline) / value,
                    i,
                );
        }
}

export function colorReader(image) {
    const { data } = image,
        channels = channelsOf(image),
        level = levelsOf(image);
    return (i, c) => level(data[channels === 1 ? i : channels * i + c]);
}

function encodePly(result) {
    let count = 0;
    forEachPoint(result, () => count++);
    const header = new TextEncoder().encode(
        `ply\nformat binary_little_endian 1.0\nelement vertex ${count}\n` +
            'property float x\nproperty float y\nproperty float z\n' +
            'property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n',
    );
    const bytes = new Uint8Array(header.length + 15 * count),
        view = new DataView(bytes.buffer);
    bytes.set(header);
    let at = header.length;
    const color = colorReader(result.left);
    forEachPoint(result, (x, y, z, i) => {
        view.setFloat32(at, x, true);
        view.setFloat32(at + 4, y, true);
        view.setFloat32(at + 8, z, true);
        for (let c = 0; c < 3; c++) bytes[at + 12 + c] = color(i, c);
        at += 15;
    });
    return bytes;
}

const encoders = { png: encodePng, pfm: encodePfm, ply: encodePly, sigma: encodeSigma, findings: encodeFindings };

export function encodeDownload({ kind, result }) {
    return encoders[kind](result);
}
