// SPDX-License-Identifier: Apache-2.0
import { defineConfig, type Plugin } from 'vite';

/** Text that may stand in an inline script: nothing in it ends the element. */
const scriptSafe = (code: string): string => code.replace(/<\/(script)/gi, '<\\/$1').replace(/<!--/g, '<\\!--');

/** Puts the one script and the one style sheet into the page, so that the page is one file. */
function inlineEverything(): Plugin {
  return {
    name: 'inline-everything',
    enforce: 'post',
    generateBundle(_options, bundle) {
      const page = bundle['index.html'];
      if (page?.type !== 'asset') throw new Error('the build has no index.html');
      let html = String(page.source).replace(/\s*<(script|link)[^>]*(src|href)="[^"]*"[^>]*>(<\/script>)?/g, '');
      for (const [name, file] of Object.entries(bundle)) {
        if (file === page) continue;
        const style = file.type === 'asset' && name.endsWith('.css');
        if (style) html = html.replace('</head>', () => `<style>${String(file.source)}</style></head>`);
        if (file.type === 'chunk') {
          html = html.replace('</body>', () => `<script type="module">${scriptSafe(file.code)}</script>\n</body>`);
        }
        if (style || file.type === 'chunk') delete bundle[name];
      }
      page.source = html;
      page.fileName = 'report.html';
    },
  };
}

export default defineConfig({
  base: './',
  plugins: [inlineEverything()],
  build: {
    target: 'es2022',
    assetsInlineLimit: 1e8,
    cssCodeSplit: false,
    modulePreload: false,
    rollupOptions: { output: { inlineDynamicImports: true } },
  },
});
