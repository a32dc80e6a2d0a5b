// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Why a pixel has its disparity: words and colours, by the numbers of HDPTreeMatcher::Reason

export const reasonWords = [
    { text: 'seen in both images', color: [62, 155, 254] },
    { text: 'hidden in the right image, filled from beside', color: [253, 163, 48] },
    { text: 'beyond the edge of the right image, filled from beside', color: [225, 220, 55] },
    { text: 'without data', color: [20, 22, 26] },
    { text: 'rejected: left and right disagree', color: [195, 36, 2] },
    { text: 'rejected: a small patch by itself', color: [160, 90, 200] },
    { text: 'found outside of its range, moved into it', color: [40, 150, 70] },
];

// The colours with their words, and how many of the pixels they are
export function showLegend(list, codes) {
    const counts = reasonWords.map(() => 0);
    for (const code of codes) counts[code]++;
    list.replaceChildren(
        ...reasonWords.flatMap(({ text, color }, code) => {
            if (counts[code] === 0) return [];
            const item = document.createElement('li');
            item.style.setProperty('--color', `rgb(${color})`);
            item.textContent = `${text}, ${((100 * counts[code]) / codes.length).toFixed(1)} %`;
            return [item];
        }),
    );
}
