import { defineConfig, type Plugin } from 'vite';

// Puts the built script and style into the page, so that it is one file that opens from disk.
function oneFile(): Plugin {
  return {
    name: 'one-file',
    enforce: 'post',
    generateBundle(_, bundle) {
      const page = bundle['index.html'];
      if (page?.type !== 'asset') throw new Error('no index.html was made');
      let html = String(page.source);
      for (const [name, part] of Object.entries(bundle)) {
        // Functions as replacements: `$` in code means nothing.
        if (part.type === 'chunk') {
          const code = part.code.replace(/<\/script/g, '<\\/script').replace(/<!--/g, '<\\!--');
          html = html.replace(new RegExp(`<script[^>]*src="[^"]*${part.fileName}"[^>]*></script>`), '');
          html = html.replace('</body>', () => `<script type="module">${code}</script>\n</body>`);
          delete bundle[name];
        } else if (name.endsWith('.css')) {
          html = html.replace(new RegExp(`<link[^>]*href="[^"]*${part.fileName}"[^>]*>`), () => `<style>${String(part.source)}</style>`);
          delete bundle[name];
        }
      }
      page.source = html;
    },
  };
}

export default defineConfig({
  base: './',
  build: { target: 'es2022', modulePreload: false, cssCodeSplit: false, assetsInlineLimit: 1e8, chunkSizeWarningLimit: 5000 },
  plugins: [oneFile()],
});
