// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Images and maps on canvases

import { channelsOf, levelsOf } from './image_data.mjs';
import { reasonWords } from './reasons.mjs';

// The turbo colour map, from blue to red, at equal distances; the ends, nearly black, are left out.
const turbo = [0x4458cb, 0x3e9bfe, 0x18d6cb, 0x46f783, 0xa4fc3b, 0xe1dc37, 0xfda330, 0xef5a11, 0xc32402];
const greyed = [120, 124, 132];
const rejected = [20, 22, 26];

const colors = Uint8Array.from({ length: 3 * 256 }, (_, i) => {
    const place = (Math.floor(i / 3) / 255) * (turbo.length - 1),
        first = Math.min(Math.floor(place), turbo.length - 2);
    const shift = 16 - 8 * (i % 3),
        channel = color => (color >> shift) & 255;
    return channel(turbo[first]) + (channel(turbo[first + 1]) - channel(turbo[first])) * (place - first);
});

// More would make the page slow, and no screen shows it.
const largestSide = 2400;

// How many pixels of an image are one of the canvas
export function reduction(width, height) {
    return Math.max(1, Math.ceil(Math.max(width, height) / largestSide));
}

// Draws what color(i, pixels, at) sets for each pixel i of an image
function draw(canvas, width, height, color) {
    const step = reduction(width, height),
        columns = Math.floor(width / step),
        rows = Math.floor(height / step);
    canvas.width = columns;
    canvas.height = rows;
    const context = canvas.getContext('2d'),
        image = context.createImageData(columns, rows),
        pixels = image.data;
    for (let y = 0, at = 0; y < rows; y++)
        for (let x = 0; x < columns; x++, at += 4) {
            color(y * step * width + x * step, pixels, at);
            pixels[at + 3] = 255;
        }
    context.putImageData(image, 0, 0);
}

export function drawImage(canvas, image) {
    const { data } = image,
        channels = channelsOf(image),
        level = levelsOf(image);
    draw(canvas, image.width, image.height, (i, pixels, at) => {
        for (let c = 0; c < 3; c++) pixels[at + c] = level(data[channels === 1 ? i : channels * i + c]);
    });
}

// The range of colours: that of the disparities, but for one in 200 at each end
export function colorRange({ disparity }, invalid) {
    const sorted = [],
        step = Math.max(1, Math.floor(disparity.length / 50000));
    for (let i = 0; i < disparity.length; i += step) if (disparity[i] !== invalid) sorted.push(disparity[i]);
    sorted.sort((a, b) => a - b);
    if (sorted.length === 0) return [0, 16];
    const low = sorted[Math.floor(0.005 * sorted.length)],
        high = sorted[Math.floor(0.995 * (sorted.length - 1))];
    return [low, Math.max(high, low + 16)];
}

export function colorOf(disparity, [low, high]) {
    const index = 3 * Math.round(255 * Math.min(Math.max((disparity - low) / (high - low), 0), 1));
    return [colors[index], colors[index + 1], colors[index + 2]];
}

// Values in their colours; those that isMissing() are not there.
function drawValues(canvas, { width, height, confidence }, values, [low, high], isMissing, threshold) {
    const scale = 255 / (high - low);
    draw(canvas, width, height, (i, pixels, at) => {
        const value = values[i];
        if (isMissing(value)) {
            [pixels[at], pixels[at + 1], pixels[at + 2]] = rejected;
        } else if (confidence[i] < threshold) {
            [pixels[at], pixels[at + 1], pixels[at + 2]] = greyed;
        } else {
            const index = 3 * Math.min(Math.max(Math.round((value - low) * scale), 0), 255);
            pixels[at] = colors[index];
            pixels[at + 1] = colors[index + 1];
            pixels[at + 2] = colors[index + 2];
        }
    });
}

export function drawDisparity(canvas, result, { range, invalid, threshold }) {
    drawValues(canvas, result, result.disparity, range, value => value === invalid, threshold);
}

// What sigma is one colour from, in pixels
export const largestSigma = 2;

export function drawSigma(canvas, result, { threshold }) {
    drawValues(canvas, result, result.sigma, [0, largestSigma], value => value === Infinity, threshold);
}

export function drawReasons(canvas, { width, height, reasons }) {
    draw(canvas, width, height, (i, pixels, at) => {
        [pixels[at], pixels[at + 1], pixels[at + 2]] = reasonWords[reasons[i]].color;
    });
}

export function drawConfidence(canvas, { width, height, confidence }, { threshold }) {
    draw(canvas, width, height, (i, pixels, at) => {
        const value = confidence[i];
        pixels[at] = value < threshold ? 150 : value;
        pixels[at + 1] = pixels[at + 2] = value < threshold ? 40 : value;
    });
}

// Of the confidence, or of anything else
export function drawScale(canvas, isConfidence) {
    draw(canvas, 256, 1, (i, pixels, at) => {
        for (let c = 0; c < 3; c++) pixels[at + c] = isConfidence ? i : colors[3 * i + c];
    });
}
