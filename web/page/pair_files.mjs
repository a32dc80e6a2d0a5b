// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Pairs from files: { left, right }, each with its name and its image. decode(file) gives an image.

import { halvesOf } from './image_data.mjs';

export const builtIn = { focal: 620, baseline: 0.19, numDisparities: 64 };

export const sizeOf = ({ width, height }) => `${width} × ${height}`;

// Throws what keeps two images from being matched.
export function checkPair({ left, right }) {
    if (left.image.width !== right.image.width || left.image.height !== right.image.height)
        throw new Error(
            `The images have different sizes: ${left.name} has ${sizeOf(left.image)} pixels, ` +
                `${right.name} ${sizeOf(right.image)}.`,
        );
    if (left.image.data.BYTES_PER_ELEMENT !== right.image.data.BYTES_PER_ELEMENT)
        throw new Error('One of the images has 8 bits, and the other one 16. Both must have the same.');
}

// left.png before right.png, L before R, 0 before 1
export function inOrder(files) {
    const { compare } = new Intl.Collator('en', { numeric: true });
    return [...files].sort((a, b) => compare(a.name, b.name));
}

export async function readImage(file, decode) {
    return { name: file.name, image: await decode(file) };
}

// From two images, or one with both side by side
export async function readPair(files, decode) {
    const [first, second, third] = inOrder(files);
    if (third) throw new Error(`These are ${files.length} files. Choose two images, or one with both side by side.`);
    const whole = await readImage(first, decode);
    if (second) return { left: whole, right: await readImage(second, decode) };
    const { width, height } = whole.image;
    if (width < 1.9 * height)
        throw new Error(`${first.name} is only one image. Choose two, or one with both side by side.`);
    const [left, right] = halvesOf(whole.image);
    return {
        left: { name: `${first.name}, left half`, image: left },
        right: { name: `${first.name}, right half`, image: right },
    };
}

export async function readBuiltIn(decode) {
    const files = await Promise.all(
        ['left', 'right'].map(async side => {
            const response = await fetch(`pair/${side}.png`);
            if (!response.ok) throw new Error('The built-in pair cannot be loaded.');
            return new File([await response.blob()], `${side}.png`);
        }),
    );
    return readPair(files, decode);
}
