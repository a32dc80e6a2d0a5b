// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Images as arrays: { width, height, data }, with grey levels, RGB or RGBA

export function channelsOf({ width, height, data }) {
    return data.length / (width * height);
}

// To 8 bits: 16-bit images from black to their brightest pixel
export function levelsOf({ data }) {
    if (!(data instanceof Uint16Array)) return level => level;
    let brightest = 1;
    for (const level of data) if (level > brightest) brightest = level;
    return level => (255 * level) / brightest;
}

// Of a picture with both images side by side
export function halvesOf(image) {
    const { width, height, data } = image,
        half = width >> 1,
        channels = channelsOf(image);
    return [0, width - half].map(first => {
        const part = new data.constructor(channels * half * height);
        for (let y = 0; y < height; y++) {
            const from = channels * (y * width + first);
            part.set(data.subarray(from, from + channels * half), channels * y * half);
        }
        return { width: half, height, data: part };
    });
}
