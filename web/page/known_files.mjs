// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What is known of a pair, from files: { width, height, data } as the matcher takes it

import { channelsOf } from './image_data.mjs';
import { decodeImage } from './images.mjs';
import { decode, hasPngSignature } from './vendor/png.mjs';

// Of any picture: 0 where it is black, 255 elsewhere
export async function decodeMask(file) {
    const image = await decodeImage(file),
        channels = channelsOf(image),
        colors = Math.min(channels, 3); // no alpha
    const data = new Uint8Array(image.width * image.height);
    for (let i = 0; i < data.length; i++)
        for (let c = 0; c < colors; c++) if (image.data[channels * i + c] > 0) data[i] = 255;
    return { width: image.width, height: image.height, data };
}

// 256 times the disparity, 0 where there is none
function ofPng(bytes) {
    const { width, height, data, channels, depth } = decode(bytes);
    if (channels !== 1 || depth !== 16) throw new Error('not of disparities');
    return { width, height, data: Float32Array.from(data, value => (value === 0 ? NaN : value / 256)) };
}

// Floating point, the last row first
function ofPfm(bytes) {
    const [header, width, height, order] = new TextDecoder('latin1')
        .decode(bytes.subarray(0, 100))
        .match(/^Pf\s+(\d+)\s+(\d+)\s+(-?)[\d.eE+-]+\s/);
    const [columns, rows] = [Number(width), Number(height)],
        view = new DataView(bytes.buffer, header.length, 4 * columns * rows),
        data = new Float32Array(columns * rows);
    for (let y = 0, at = 0; y < rows; y++)
        for (let x = 0; x < columns; x++, at += 4) {
            const value = view.getFloat32(at, order === '-');
            data[(rows - 1 - y) * columns + x] = Number.isFinite(value) ? value : NaN;
        }
    return { width: columns, height: rows, data };
}

// In pixels, NaN where there is none: the files of downloads.mjs
export async function decodeDisparity(file) {
    const bytes = new Uint8Array(await file.arrayBuffer());
    try {
        return hasPngSignature(bytes) ? ofPng(bytes) : ofPfm(bytes);
    } catch {
        throw new Error(
            `${file.name} is no map of disparities: a PFM, or a PNG of 16 bits with 256 times the disparity.`,
        );
    }
}

// The text of a file, with the size of its pair. check(text) throws if a matcher does not take it.
export async function decodeFindings(file, check) {
    const text = await file.text();
    try {
        check(text);
    } catch {
        throw new Error(`${file.name} has no findings: it must be a file that this page or PairModel has saved.`);
    }
    const [width, height] = ['width', 'height'].map(name => Number(text.match(new RegExp(`\\b${name}\\W+(\\d+)`))[1]));
    return { width, height, data: text };
}
