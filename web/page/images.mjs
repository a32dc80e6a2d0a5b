// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// From files to pixels: { width, height, data }, with grey levels, RGB or RGBA of 8 bits, or of 16 bits of a PNG

import { decode, hasPngSignature } from './vendor/png.mjs';

const tooManyMegapixels = 60;

function checkSize(width, height, name) {
    const megapixels = (width * height) / 1e6;
    if (megapixels >= tooManyMegapixels)
        throw new Error(
            `${name} has ${Math.round(megapixels)} megapixels. This page takes less than ${tooManyMegapixels}: ` +
                'make it smaller first.',
        );
}

function sizeOfPng(bytes) {
    const view = new DataView(bytes.buffer);
    return [view.getUint32(16), view.getUint32(20)];
}

// Grey, RGB or RGBA
function withoutPalette({ width, height, data, channels, depth, palette }) {
    const pixels = width * height;
    if (palette) {
        const colors = new Uint8Array(3 * pixels),
            bits = depth,
            perByte = 8 / bits;
        const stride = Math.ceil(width / perByte);
        for (let y = 0; y < height; y++)
            for (let x = 0; x < width; x++) {
                const byte = data[y * stride + Math.floor(x / perByte)];
                const index = (byte >> (8 - bits * ((x % perByte) + 1))) & ((1 << bits) - 1);
                colors.set((palette[index] ?? [0, 0, 0]).slice(0, 3), 3 * (y * width + x));
            }
        return { width, height, data: colors };
    }
    if (depth < 8) throw new Error('less than 8 bits'); // for the browser
    if (channels !== 2) return { width, height, data };
    const grey = new data.constructor(pixels);
    for (let i = 0; i < pixels; i++) grey[i] = data[2 * i];
    return { width, height, data: grey };
}

async function decodeByBrowser(file, name) {
    let bitmap;
    try {
        // The levels as they are in the file
        bitmap = await createImageBitmap(file, { colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
    } catch {
        throw new Error(`${name} is not an image that this browser can read. PNG and JPEG are.`);
    }
    const { width, height } = bitmap;
    checkSize(width, height, name);
    const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
    context.drawImage(bitmap, 0, 0);
    bitmap.close();
    return { width, height, data: context.getImageData(0, 0, width, height).data };
}

export async function decodeImage(file) {
    const name = file.name || 'The image',
        bytes = new Uint8Array(await file.arrayBuffer());
    if (bytes.length >= 24 && hasPngSignature(bytes)) {
        checkSize(...sizeOfPng(bytes), name);
        try {
            return withoutPalette(decode(bytes));
        } catch {
            // of a kind that fast-png does not know: as any other image
        }
    }
    return decodeByBrowser(file, name);
}
